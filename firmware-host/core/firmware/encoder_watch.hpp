// SPDX-License-Identifier: Apache-2.0
// Detects jumps of the encoder's count, and missing counts.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// If the encoder was not read for longer than this, the drive falls and rises again.
inline constexpr float kBlindS = 0.01F;
inline uint32_t blind_ticks(float rate_hz) noexcept {
  return static_cast<uint32_t>(kBlindS * rate_hz);
}

/// If no count is read for kBlindS, the ticks are blind: the last count is held until the encoder is read
/// again and the drive is at rest. Only then is the new count used, however far away it is. After a shorter
/// time, the count may have moved by counts_per_tick for each period; more is a jump. Safe in the tick.
class EncoderWatch {
 public:
  void arm(uint32_t counts_per_tick, float rate_hz, int32_t encoder) noexcept;
  /// The count to play. `unseen`: periods in which the encoder was not read, up to now; `at_rest`: whether
  /// the drive is at rest.
  int32_t see(int32_t encoder, uint32_t unseen, bool at_rest) noexcept;
  /// Whether the drive has to fall.
  bool blind() const noexcept { return blind_; }
  /// Whether this is the first count after blind ticks: the earlier place and speed are not valid any more.
  bool found() const noexcept { return found_; }
  /// The size of a jump in counts; 0: no jump.
  uint32_t jump() const noexcept { return jump_; }

 private:
  uint32_t counts_per_tick_ = 0, blind_ticks_ = 0;
  int32_t count_ = 0;
  uint32_t jump_ = 0;
  bool blind_ = false, found_ = false;
};

}  // namespace tacto::core
