// SPDX-License-Identifier: Apache-2.0
// Start-up and the table of interrupts.
#include <stdint.h>

extern "C" {
extern uint32_t stack_top, data_begin, data_end, data_source, bss_begin, bss_end;
extern void (*init_begin[])();
extern void (*init_end[])();

void systick_handler();
void usart1_handler();
[[noreturn]] void fault_handler();
[[noreturn]] void run();
[[noreturn]] void reset_handler();
}

void reset_handler() {
  *reinterpret_cast<volatile uint32_t*>(0xE000ED88) |= 0xF00000;  // the FPU on
  asm volatile("dsb\n isb");
  for (uint32_t *to = &data_begin, *from = &data_source; to < &data_end;) *to++ = *from++;
  for (uint32_t* word = &bss_begin; word < &bss_end; ++word) *word = 0;
  for (auto init = init_begin; init < init_end; ++init) (*init)();
  run();
}

struct Vectors {
  const void* stack;
  void (*handlers[15 + 82])();
};

constexpr Vectors make_vectors() {
  Vectors table{&stack_top, {}};
  for (auto& handler : table.handlers) handler = fault_handler;
  table.handlers[0] = reset_handler;
  table.handlers[14] = systick_handler;
  table.handlers[15 + 37] = usart1_handler;
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constexpr Vectors kVectors = make_vectors();

[[gnu::section(".check"), gnu::used]] constexpr uint32_t kImageCheck = 0;
