// SPDX-License-Identifier: Apache-2.0
// The finger's place between the encoder's counts, and its speed.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// In counts and ticks. `count` stands for the stretch from count to count + 1.
struct FingerPlace {
  int32_t count = 0;
  float offset = 0;           ///< from count on: 0 to 1, before looking ahead
  float counts_per_tick = 0;  ///< signed
};

struct TrackerSetup {
  bool between_counts = false;  ///< false: the count alone is the place
  float look_ahead_ticks = 0;   ///< the place is where the finger will be: + counts_per_tick x this
  float smoothing_ticks = 100;  ///< over which speed is averaged where counts come every tick
};

/// The greatest weight of an edge. Measured with an encoder of 1 um (position where the finger will be in 2
/// ms, RMS): 0.04 um at constant speed, 1 um at 2 kHz and 0.4 um at 10 kHz with 10 % of speed wander at 1.5
/// Hz.
inline constexpr float kMostAlpha = 0.1F;

/// Times the edges: an edge is known to lie at a count's border, crossed within the last tick (where counts
/// come every tick, the middle of the count is what is known); between edges the finger goes on at its speed,
/// but the place that is given never leaves the count that the encoder shows. An alpha-beta filter whose
/// gains begin with those of a straight line through what was seen (2 (2 n - 1) / (n (n + 1)), 6 / (n (n +
/// 1))) and settle at alpha = t / (t + smoothing), t the ticks since the last edge, at most kMostAlpha; beta
/// = alpha^2 / (2 - alpha). A miss beyond what is not known of an edge (half a tick's way, at most half a
/// count, and 0.1 counts) weighs 0.2 to 0.5. It begins again where the finger turns, or is off by 4 counts.
/// An edge that is long overdue bounds the speed by 1.5 / t: a finger that stops comes to rest. Safe in the
/// tick.
class FingerTracker {
 public:
  void set(const TrackerSetup& setup) noexcept;
  /// The place at this tick; with looking ahead, the place of then: offset may then be any number of counts.
  FingerPlace track(int32_t count) noexcept;
  /// |counts_per_tick|, as of the last track().
  float speed() const noexcept { return speed_ < 0 ? -speed_ : speed_; }

 private:
  struct Gains {
    float alpha = 0, beta = 0;
  };
  static Gains gains_of(float alpha) noexcept;
  Gains gains(float miss, float since) noexcept;
  void begin(int32_t count) noexcept;
  void see(int32_t moved) noexcept;
  void turn(int32_t moved) noexcept;
  void correct(float miss, float since) noexcept;
  void stay() noexcept;

  TrackerSetup setup_;
  Gains every_tick_;  // once settled, where counts come every tick
  bool begun_ = false;
  int32_t count_ = 0;
  float offset_ = 0, speed_ = 0;  // from count_; counts a tick
  float since_ = 0;               // ticks since the last edge
  int32_t seen_ = 0;              // edges since it began again
};

}  // namespace tacto::core
