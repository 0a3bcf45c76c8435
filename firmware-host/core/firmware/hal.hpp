// SPDX-License-Identifier: Apache-2.0
// The hardware layer: all functions that the core needs from a board.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace tacto::core {

/// Nine required functions and an optional one; `board` is passed to each. None of them waits, allocates or
/// throws. Those marked (tick) are called in the tick's interrupt.
struct Hal {
  void* board = nullptr;
  /// (tick) The encoder's count.
  int32_t (*read_encoder)(void* board) noexcept = nullptr;
  /// (tick) The number of previous periods in which the encoder was not read. Only for a board that receives
  /// counts over a cable; null if the counter is in the hardware.
  uint32_t (*encoder_unseen)(void* board) noexcept = nullptr;
  /// (tick) One code per channel, in the order of the board's channels: left-justified in 32 bits, for an
  /// encoder its plain count. False if a converter failed.
  bool (*read_channels)(void* board, int32_t* codes) noexcept = nullptr;
  /// (tick) Volts at the amplifier's input, held until the next tick.
  void (*write_drive)(void* board, float drive_v) noexcept = nullptr;
  /// (tick) The counts of all axes, of a device with forces.
  void (*read_axes)(void* board, int32_t* counts) noexcept = nullptr;
  /// (tick) Newtons on the hand for each axis, held until the next tick.
  void (*write_forces)(void* board, const float* force_n) noexcept = nullptr;
  /// (tick) True while the hardware enable input is closed; always true on a board without one.
  bool (*enable_closed)(void* board) noexcept = nullptr;
  /// (tick) The device's clock; it does not wrap.
  uint64_t (*clock)(void* board) noexcept = nullptr;
  /// Sets the tick rate, from the first sample period on; 0: no ticks. The converters restart.
  void (*set_rate)(void* board, uint32_t rate_millihertz) noexcept = nullptr;
  /// Received bytes, at most `capacity`; returns their number.
  size_t (*receive)(void* board, uint8_t* bytes, size_t capacity) noexcept = nullptr;
  /// Sends bytes to the host; returns the number of accepted bytes.
  size_t (*send)(void* board, const uint8_t* bytes, size_t size) noexcept = nullptr;
  /// Restarts as after power-on; does not have to return.
  void (*restart)(void* board) noexcept = nullptr;
};

}  // namespace tacto::core
