// SPDX-License-Identifier: Apache-2.0
// What a board does before its program: fills the RAM, and lists its interrupts.
#pragma once

#include <stdint.h>

extern "C" {
extern uint32_t data_begin, data_end, data_source, bss_begin, bss_end;  // memory.ld
extern void (*init_begin[])();
extern void (*init_end[])();
}

namespace tacto::boards {

/// Copies what the flash has for the RAM, clears the rest of it, and runs the constructors. Inlined, and its
/// loops are no calls of memcpy: on a board that runs from RAM no other code is in its place yet.
[[gnu::always_inline]] inline void fill_memory() {
  for (uint32_t *to = &data_begin, *from = &data_source; to < &data_end;) {
    *to++ = *from++;
    asm volatile("" ::: "memory");
  }
  for (uint32_t* word = &bss_begin; word < &bss_end;) {
    *word++ = 0;
    asm volatile("" ::: "memory");
  }
  for (auto init = init_begin; init < init_end; ++init) (*init)();
}

/// The stack, then the handlers of exceptions 1 to 15 and of the interrupts.
template <unsigned kInterrupts>
struct Vectors {
  const void* stack;
  void (*handlers[15 + kInterrupts])();
};
inline constexpr unsigned kResetVector = 0, kSysTickVector = 14, kFirstInterrupt = 15;  ///< of `handlers`

template <unsigned kInterrupts>
constexpr Vectors<kInterrupts> all_faults(const void* stack, void (*fault_handler)()) {
  Vectors<kInterrupts> table{stack, {}};
  for (auto& handler : table.handlers) handler = fault_handler;
  return table;
}

}  // namespace tacto::boards
