// SPDX-License-Identifier: Apache-2.0
// Start-up and the table of interrupts.
#include "firmware-host/boards/shared/start.hpp"

#include "firmware-host/boards/shared/cortex_m.hpp"

extern "C" {
extern uint32_t stack_top;

void systick_handler();
void usart1_handler();
[[noreturn]] void fault_handler();
[[noreturn]] void run();
[[noreturn]] void reset_handler();
}

void reset_handler() {
  tacto::boards::start_fpu();
  tacto::boards::fill_memory();
  run();
}

namespace {

using namespace tacto::boards;

constexpr auto make_vectors() {
  auto table = all_faults<82>(&stack_top, fault_handler);
  table.handlers[kResetVector] = reset_handler;
  table.handlers[kSysTickVector] = systick_handler;
  table.handlers[kFirstInterrupt + 37] = usart1_handler;
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constexpr auto kVectors = make_vectors();

[[gnu::section(".check"), gnu::used]] constexpr uint32_t kImageCheck = 0;

}  // namespace
