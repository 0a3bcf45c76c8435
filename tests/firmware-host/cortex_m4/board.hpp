// SPDX-License-Identifier: GPL-3.0-or-later
// The few things that a bare Cortex-M4F in QEMU gives a program: text out, a counter, an end.
#pragma once

#include <stdint.h>

namespace tacto::cortex_m4 {

void say(const char* text);
void say(const char* name, uint32_t value);
[[noreturn]] void end(bool passed);

/// SysTick counts downwards at the core's 168 MHz. Under -icount an instruction takes one virtual nanosecond.
uint32_t counter();
/// Counts from \p before to \p after; less than a tenth of a second apart.
inline uint32_t counted(uint32_t before, uint32_t after) {
  return (before - after) & 0xFFFFFFU;
}

/// Bytes of stack that were in use at the deepest, since the start.
uint32_t deepest_stack();

/// The program.
void run();

}  // namespace tacto::cortex_m4
