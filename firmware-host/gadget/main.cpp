// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/gadget.hpp"

int main(int count, char** values) {
  return tacto::firmware_host::run_gadget({values + 1, values + count});
}
