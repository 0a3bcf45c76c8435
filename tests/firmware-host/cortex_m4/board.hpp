// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of a bare Cortex-M4F in QEMU: text output, a counter, exit.
#pragma once

#include <stdint.h>

namespace tacto::cortex_m4 {

void say(const char* text);
void say(const char* name, uint32_t value);
[[noreturn]] void end(bool passed);

/// SysTick counts downwards at the core's 168 MHz. Under -icount an instruction takes one virtual nanosecond.
uint32_t counter();
/// Counts from \p before to \p after, which are less than a tenth of a second apart.
inline uint32_t counted(uint32_t before, uint32_t after) {
  return (before - after) & 0xFFFFFFU;
}

/// Largest use of the stack since the start, bytes.
uint32_t deepest_stack();

/// The program, which the start-up code calls.
void run();

}  // namespace tacto::cortex_m4
