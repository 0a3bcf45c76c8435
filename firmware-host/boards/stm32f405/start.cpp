// SPDX-License-Identifier: Apache-2.0
// Start-up, the table of interrupts, and the functions that compilers call implicitly.
#include <stddef.h>
#include <stdint.h>

extern "C" {
extern uint32_t stack_top, data_begin, data_end, data_source, bss_begin, bss_end;
extern void (*init_begin[])();
extern void (*init_end[])();

// no_builtin: otherwise the compiler would replace the loops by calls of these functions.
[[clang::no_builtin]] void* memcpy(void* to, const void* from, size_t size) {
  for (size_t i = 0; i < size; ++i) static_cast<char*>(to)[i] = static_cast<const char*>(from)[i];
  return to;
}
[[clang::no_builtin]] void* memset(void* to, int value, size_t size) {
  for (size_t i = 0; i < size; ++i) static_cast<char*>(to)[i] = static_cast<char>(value);
  return to;
}
void __aeabi_memcpy(void* to, const void* from, size_t size) {
  memcpy(to, from, size);
}
void __aeabi_memcpy4(void* to, const void* from, size_t size) {
  memcpy(to, from, size);
}
void __aeabi_memcpy8(void* to, const void* from, size_t size) {
  memcpy(to, from, size);
}
[[clang::no_builtin]] void __aeabi_memmove(void* to, const void* from, size_t size) {
  if (to < from) memcpy(to, from, size);
  if (to > from)
    while (size-- > 0) static_cast<char*>(to)[size] = static_cast<const char*>(from)[size];
}
void __aeabi_memclr(void* to, size_t size) {
  memset(to, 0, size);
}
void __aeabi_memclr4(void* to, size_t size) {
  memset(to, 0, size);
}
void __aeabi_memclr8(void* to, size_t size) {
  memset(to, 0, size);
}

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
