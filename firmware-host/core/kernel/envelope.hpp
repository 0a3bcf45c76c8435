// SPDX-License-Identifier: Apache-2.0
// Soft onset, and the ramp to zero.
#pragma once

namespace tacto::core {

/// A level l that rises or falls linearly, one step per tick, and its weight w = l^2 (3 - 2 l), whose slope
/// is zero at both ends. From any level it reaches zero after at most ceil(release ticks) + 1. Safe in the
/// tick.
class Envelope {
 public:
  /// Times in ticks; values below one are treated as one.
  void set(float onset_ticks, float release_ticks) noexcept {
    rise_ = onset_ticks > 1 ? 1 / onset_ticks : 1;
    fall_ = release_ticks > 1 ? 1 / release_ticks : 1;
    level_ = 0;
  }
  float step(bool raise) noexcept {
    if (raise && level_ >= 1) return 1;
    level_ += raise ? rise_ : -fall_;
    level_ = level_ < 0 ? 0 : level_ > 1 ? 1 : level_;
    return level_ * level_ * (3 - 2 * level_);
  }
  bool at_rest() const noexcept { return level_ <= 0; }

 private:
  float rise_ = 1, fall_ = 1, level_ = 0;
};

}  // namespace tacto::core
