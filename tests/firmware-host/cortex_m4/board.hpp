// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of a bare Cortex-M in QEMU: text output, a counter, exit.
#pragma once

#include <stdint.h>

namespace tacto::cortex_m4 {

void say(const char* text);
void say(const char* name, uint32_t value);
[[noreturn]] void end(bool passed);

/// SysTick counts downwards at the machine's clock. Under -icount each instruction takes the same virtual
/// time.
uint32_t counter();
/// Says how many counts 10,000 instructions take.
void calibrate();
/// Counts from \p before to \p after, which are less than a tenth of a second apart.
inline uint32_t counted(uint32_t before, uint32_t after) {
  return (before - after) & 0xFFFFFFU;
}

/// Largest use of the stack since the start, bytes.
uint32_t deepest_stack();

/// The program, which the start-up code calls.
void run();

}  // namespace tacto::cortex_m4
