// SPDX-License-Identifier: Apache-2.0
// The registers of the core itself, equal on a Cortex-M4 and a Cortex-M33 (ARMv7-M Architecture Reference
// Manual, B3; ARMv8-M, D1.2).
#pragma once

#include <stdint.h>

namespace tacto::boards {

inline volatile uint32_t& at(uint32_t address) {
  return *reinterpret_cast<volatile uint32_t*>(address);
}

inline volatile uint32_t &syst_csr = at(0xE000E010), &syst_rvr = at(0xE000E014), &syst_cvr = at(0xE000E018),
                         &nvic_iser1 = at(0xE000E104), &scb_aircr = at(0xE000ED0C),
                         &scb_shpr3 = at(0xE000ED20);

/// Inlined, and by its address: it is called before constructors, and before code is in its place.
[[gnu::always_inline]] inline void start_fpu() {
  at(0xE000ED88) = at(0xE000ED88) | 0xF00000;
  asm volatile("dsb\n isb" ::: "memory");
}

/// Waits for flags that hardware sets; false if they are not set after so many loops.
inline bool await(const volatile uint32_t& flags, uint32_t mask, uint32_t wanted,
                  uint32_t loops = 1'000'000) {
  for (uint32_t i = 0; i < loops; ++i)
    if ((flags & mask) == wanted) return true;
  return false;
}

}  // namespace tacto::boards
