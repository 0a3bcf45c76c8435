// SPDX-License-Identifier: Apache-2.0
// What the boot ROM finds in the flash, the start-up of both cores, and the table of interrupts.
#include "firmware-host/boards/shared/start.hpp"

#include "firmware-host/boards/shared/cortex_m.hpp"

extern "C" {
extern uint32_t link_stack_top, tick_stack_top;

void systick_handler();
[[noreturn]] void fault_handler();
[[noreturn]] void run_link();
[[noreturn]] void run_ticks();
[[noreturn]] void reset_handler();
[[noreturn]] void boot_fault();
[[noreturn]] void start_ticks();
extern const tacto::boards::Vectors<52> vectors;
}

// In the flash, before the RAM has any code.
[[gnu::section(".start")]] void boot_fault() {
  for (;;) {
  }
}

[[gnu::section(".start")]] void reset_handler() {
  tacto::boards::start_fpu();
  tacto::boards::fill_memory();
  tacto::boards::at(0xE000ED08) = reinterpret_cast<uint32_t>(&vectors);  // VTOR
  run_link();
}

// Core 1 begins here, with the stack and the vectors that core 0 names (board.cpp).
void start_ticks() {
  tacto::boards::start_fpu();
  run_ticks();
}

namespace {

using namespace tacto::boards;

// RP2350 datasheet, 5.9.5: an image begins with its stack and its entry, and has an IMAGE_DEF in its first 4
// KB.
struct BootVectors {
  const void* stack;
  void (*handlers[3])();  // reset, NMI, hard fault
};
[[gnu::section(".boot_vectors"), gnu::used]] constexpr BootVectors kBootVectors{
    &link_stack_top, {reset_handler, boot_fault, boot_fault}};

// 5.9.5.1: one block with the type of the image (an executable, secure, Arm, RP2350) that links to itself.
[[gnu::section(".image_def"), gnu::used]] constexpr uint32_t kImageDef[5] = {0xFFFFDED3, 0x10210142,
                                                                             0x000001FF, 0, 0xAB123579};

[[gnu::section(".check"), gnu::used]] constexpr uint32_t kImageCheck = 0;

constexpr auto make_vectors() {
  auto table = all_faults<52>(&link_stack_top, fault_handler);
  table.handlers[kResetVector] = reset_handler;
  table.handlers[kSysTickVector] = systick_handler;
  return table;
}

}  // namespace

[[gnu::section(".vectors"), gnu::used]] constexpr Vectors<52> vectors = make_vectors();
