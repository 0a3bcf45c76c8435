// SPDX-License-Identifier: GPL-3.0-or-later
// A drive whose values identify their position, and a check of the drive that a device played.
#pragma once

#include <cstdint>
#include <cstring>

#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::tests {

/// Value `index`, within +-0.5 V: a hash (splitmix64), so that no sequence of values occurs twice.
inline float drive_of(std::uint64_t index) {
  std::uint64_t bits = (index + 1) * 0x9E3779B97F4A7C15;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EB;
  return static_cast<float>(static_cast<std::int32_t>((bits ^ (bits >> 31)) >> 40) - (1 << 23)) /
         static_cast<float>(1 << 24);
}

/// Takes a device's ticks in order. The first values may pass before the device plays. From then on each tick
/// must play the next value to the bit, or report that it had none; the number of those must be the device's
/// own count.
class DriveCheck {
 public:
  void take(const wire::Ticks& ticks) {
    missing_ += ticks.first_tick - tick_;
    tick_ = ticks.first_tick + ticks.count;
    for (std::uint8_t i = 0; i < ticks.count; ++i) take(ticks.ticks[i]);
  }

  /// Values that certainly are consumed.
  std::uint64_t used() const { return next_; }
  bool begun() const { return as_sent_ > 0; }
  std::uint64_t as_sent() const { return as_sent_; }
  std::uint64_t otherwise() const { return otherwise_; }
  std::uint64_t missing() const { return missing_; }

 private:
  static constexpr std::uint64_t kMostBefore = 100000;  // values: ten seconds

  static bool same(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

  void take(const wire::Tick& tick) {
    if ((tick.flags & wire::kTickPlaying) == 0) return;
    if (!begun() && tick.drive_v != 0) find(tick.drive_v);
    const bool sent = same(tick.drive_v, drive_of(next_));
    next_ += sent;
    as_sent_ += sent;
    otherwise_ += !sent;
  }

  void find(float drive_v) {
    for (std::uint64_t index = 0; index < kMostBefore; ++index)
      if (same(drive_v, drive_of(index))) next_ = index;
  }

  std::uint64_t tick_ = 0, next_ = 0, missing_ = 0, as_sent_ = 0, otherwise_ = 0;
};

}  // namespace tacto::tests
