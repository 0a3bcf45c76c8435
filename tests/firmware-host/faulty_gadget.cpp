// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph-gadget with simulated faults, for tests of a host: faulty_gadget FAULTS OPTION...; FAULTS as of
// parse_fault_plan().
#include <cstdio>

#include "firmware-host/gadget/gadget.hpp"
#include "tests/firmware-host/faulty_link.hpp"

int main(int count, char** values) {
  const auto plan = tacto::tests::parse_fault_plan(count > 1 ? values[1] : "");
  if (count < 2 || !plan) {
    std::fprintf(stderr, "usage: faulty_gadget FAULTS OPTION... (tests/firmware-host/faulty_link.hpp)\n");
    return 2;
  }
  const auto wrap = [&](tacto::firmware_host::BoardLink& link) {
    return std::make_unique<tacto::tests::FaultyLink>(link, *plan);
  };
  return tacto::firmware_host::run_gadget({values + 2, values + count}, {wrap, plan->stop_reading_after});
}
