// SPDX-License-Identifier: Apache-2.0
// What becomes of the drive when the encoder's count jumps, or does not come.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// Where the encoder was not read for longer than this, the drive falls and comes back.
inline constexpr float kBlindS = 0.01F;
inline uint32_t blind_ticks(float rate_hz) noexcept {
  return static_cast<uint32_t>(kBlindS * rate_hz);
}

/// A count that lacks for kBlindS blinds: the count before is held until it is read again and the drive has
/// come to rest, and only then the new one is followed, however far away. Over less, what the finger may go
/// in that time is no jump; more is. Safe in the tick.
class EncoderWatch {
 public:
  void arm(uint32_t counts_per_tick, float rate_hz, int32_t encoder) noexcept;
  /// The count to play. `unseen`: periods in which the encoder was not read, up to now; `at_rest`: the drive.
  int32_t see(int32_t encoder, uint32_t unseen, bool at_rest) noexcept;
  /// The drive is to fall.
  bool blind() const noexcept { return blind_; }
  /// This count is the first one after blindness: what was known of the finger is not true any more.
  bool found() const noexcept { return found_; }
  /// Counts, where this one is further away than a finger goes; else 0.
  uint32_t jump() const noexcept { return jump_; }

 private:
  uint32_t counts_per_tick_ = 0, blind_ticks_ = 0;
  int32_t count_ = 0;
  uint32_t jump_ = 0;
  bool blind_ = false, found_ = false;
};

}  // namespace tacto::core
