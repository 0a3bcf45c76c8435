// SPDX-License-Identifier: GPL-3.0-or-later
// Start-up and semihosting.
#include "tests/firmware-host/cortex_m4/board.hpp"

extern "C" {
extern uint32_t stack_top, data_begin, data_end, data_source, bss_begin, bss_end;
extern void (*init_begin[])();
extern void (*init_end[])();

[[noreturn]] void reset_handler();
[[noreturn]] void fault_handler();
}

namespace tacto::cortex_m4 {
namespace {

constexpr uint32_t kPaint = 0xDEADBEEF;
constexpr uint32_t kSysWrite0 = 0x04, kSysExit = 0x18, kStoppedApplicationExit = 0x20026;

uint32_t semihost(uint32_t operation, uint32_t argument) {
  register uint32_t r0 asm("r0") = operation;
  register uint32_t r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

volatile uint32_t& device_register(uint32_t address) {
  return *reinterpret_cast<volatile uint32_t*>(address);
}

void paint_stack() {
  uint32_t here = 0;
  asm volatile("mov %0, sp" : "=r"(here));
  for (uint32_t* word = &bss_end; reinterpret_cast<uint32_t>(word) < here - 64; ++word) *word = kPaint;
}

}  // namespace

void say(const char* text) {
  semihost(kSysWrite0, reinterpret_cast<uint32_t>(text));
}

void say(const char* name, uint32_t value) {
  char digits[12] = "          \n";
  for (int i = 9; i >= 0 && (value > 0 || i == 9); --i, value /= 10)
    digits[i] = static_cast<char>('0' + value % 10);
  say(name);
  say(" ");
  say(digits);
}

void end(bool passed) {
  semihost(kSysExit, passed ? kStoppedApplicationExit : 1);
  for (;;) {
  }
}

uint32_t counter() {
  return device_register(0xE000E018);
}

// A loop of two instructions.
void calibrate() {
  uint32_t left = 5000;
  const uint32_t before = counter();
  asm volatile("1: subs %0, #1\n bne 1b" : "+l"(left) : : "cc");
  say("counts_of_10000_instructions", counted(before, counter()));
}

uint32_t deepest_stack() {
  const uint32_t* word = &bss_end;
  while (word < &stack_top && *word == kPaint) ++word;
  return reinterpret_cast<uint32_t>(&stack_top) - reinterpret_cast<uint32_t>(word);
}

}  // namespace tacto::cortex_m4

void reset_handler() {
  using tacto::cortex_m4::device_register;
  device_register(0xE000ED88) |= 0xF00000;  // the FPU on
  asm volatile("dsb\n isb");
  for (uint32_t *to = &data_begin, *from = &data_source; to < &data_end;) *to++ = *from++;
  for (uint32_t* word = &bss_begin; word < &bss_end; ++word) *word = 0;
  device_register(0xE000E014) = 0xFFFFFF;  // SysTick: reload, enable, at the core's clock
  device_register(0xE000E018) = 0;
  device_register(0xE000E010) = 5;
  tacto::cortex_m4::paint_stack();
  for (auto init = init_begin; init < init_end; ++init) (*init)();
  tacto::cortex_m4::run();
  tacto::cortex_m4::end(true);
}

void fault_handler() {
  tacto::cortex_m4::say("hardware fault\n");
  tacto::cortex_m4::end(false);
}

[[gnu::section(".vectors"), gnu::used]] const void* const vectors[16] = {
    &stack_top,
    reinterpret_cast<const void*>(reset_handler),
    reinterpret_cast<const void*>(fault_handler),
    reinterpret_cast<const void*>(fault_handler),
    reinterpret_cast<const void*>(fault_handler),
    reinterpret_cast<const void*>(fault_handler),
    reinterpret_cast<const void*>(fault_handler),
};
