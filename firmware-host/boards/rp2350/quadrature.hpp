// SPDX-License-Identifier: Apache-2.0
// A program for the programmable I/O of an RP2350 that counts the edges of a quadrature encoder.
#pragma once

#include <stdint.h>

namespace tacto::rp2350 {

// The instructions that it uses, as words (RP2350 datasheet, 11.4).
namespace pio {
enum Register : uint16_t { pins = 0, x = 1, y = 2, pc = 5, isr = 6, osr = 7 };
constexpr uint16_t jump(unsigned to) {
  return static_cast<uint16_t>(to);
}
constexpr uint16_t jump_and_decrement_y(unsigned to) {
  return static_cast<uint16_t>(4U << 5 | to);
}
constexpr uint16_t in(Register from, unsigned bits) {
  return static_cast<uint16_t>(0x4000U | from << 5 | bits);
}
constexpr uint16_t out(Register to, unsigned bits) {
  return static_cast<uint16_t>(0x6000U | to << 5 | bits);
}
constexpr uint16_t move(Register to, Register from) {
  return static_cast<uint16_t>(0xA000U | to << 5 | from);
}
constexpr uint16_t move_inverted(Register to, Register from) {
  return static_cast<uint16_t>(0xA000U | to << 5 | 1U << 3 | from);
}
constexpr uint16_t set_y(unsigned value) {
  return static_cast<uint16_t>(0xE000U | y << 5 | value);
}
/// Entry 0 of the receive FIFO, which the processor reads at any time (PIO version 1; 11.4.8).
constexpr uint16_t store_isr = 0x8018;
}  // namespace pio

// Places in the program, behind a jump for each pair of an old and a new state of the pins, 4 old + new.
inline constexpr unsigned kDown = 16, kStore = 17, kSample = 19, kUp = 23, kProgramEnd = 26;

struct Program {
  uint16_t words[kProgramEnd];
};

/// Y is the count. A state is A + 2 B, and counts upwards as 0, 1, 3, 2: A leads. The old state is in the
/// output shift register, from which two bits are shifted to the right; inputs are shifted to the left, so
/// that the input shift register has 4 old + new, the address of a jump. Two edges within one sample are no
/// count. It wraps from the end to kStore; a sample takes at most ten periods of the state machine.
constexpr Program quadrature_program() {
  Program program{};
  for (unsigned old = 0; old < 4; ++old)
    for (unsigned now = 0; now < 4; ++now) {
      constexpr unsigned kNextUp[4] = {1, 3, 0, 2};
      program.words[4 * old + now] = pio::jump(now == kNextUp[old]   ? kUp
                                               : old == kNextUp[now] ? kDown
                                                                     : kSample);
    }
  uint16_t* const at = program.words;
  at[kDown] = pio::jump_and_decrement_y(kStore);
  at[kStore] = pio::move(pio::isr, pio::y);
  at[kStore + 1] = pio::store_isr;
  at[kSample] = pio::out(pio::isr, 2);
  at[kSample + 1] = pio::in(pio::pins, 2);
  at[kSample + 2] = pio::move(pio::osr, pio::isr);
  at[kSample + 3] = pio::move(pio::pc, pio::isr);
  at[kUp] = pio::move_inverted(pio::y, pio::y);
  at[kUp + 1] = pio::jump_and_decrement_y(kUp + 2);
  at[kUp + 2] = pio::move_inverted(pio::y, pio::y);
  return program;
}

}  // namespace tacto::rp2350
