// SPDX-License-Identifier: GPL-3.0-or-later
// Figures from the ticks of a run: the last tick, counts, the finger's speed, the drive's level.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "data-schema/session/session.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// Receives ticks one by one; does not allocate.
class TickView {
 public:
  /// Resets all figures.
  void begin(double rate_hz, double metres_per_count);
  /// The range of positions in which the following ticks have a texture; before, all positions have one.
  void textures_from(double from_m, double to_m) { from_m_ = from_m, to_m_ = to_m; }
  /// Call in the order of the ticks.
  void take(const schema::SessionTick& tick);
  void take_loss(std::uint64_t count) { lost_ += count; }

  std::uint64_t expected() const { return expected_; }
  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t late() const { return late_; }
  std::uint64_t limited() const { return limits_.amplitude_or_slew; }
  /// Those whose force was limited at its peak, or in its change.
  std::uint64_t peak_limited() const { return limits_.amplitude; }
  std::uint64_t slew_limited() const { return limits_.slew; }
  /// Ticks whose drive or force was reduced to keep its RMS limit.
  std::uint64_t energy_limited() const { return limits_.energy; }
  /// Ticks during playback in which the contact gate reduced the drive: no contact, or contact began or ended
  /// just now.
  std::uint64_t gated() const { return gated_; }
  /// Ticks in which the drive fell because no count came.
  std::uint64_t blind() const { return blind_; }
  /// The part of the ticks in the last whole second that were late.
  double late_part() const { return late_part_; }
  const schema::SessionTick& last() const { return last_; }
  /// Time in play; lost ticks count as not played.
  double playing_s() const { return static_cast<double>(playing_) / rate_hz_; }
  /// The share of the time in play in which the finger was off the textures; 0 before play.
  double off_textures() const {
    return playing_ == 0 ? 0 : static_cast<double>(off_) / static_cast<double>(playing_);
  }
  double span_s() const { return static_cast<double>(expected_) / rate_hz_; }
  double position_m() const { return metres_per_count_ * static_cast<double>(count_); }
  /// The smallest and the greatest position so far.
  double least_position_m() const { return metres_per_count_ * static_cast<double>(least_); }
  double greatest_position_m() const { return metres_per_count_ * static_cast<double>(greatest_); }
  /// Over the last 20 ms; positive as the encoder counts up.
  double speed_mps() const;
  /// Over about the last 100 ms.
  double drive_rms_v() const;
  double drive_peak_v() const { return peak_v_; }
  double force_peak_n() const { return force_peak_n_; }  ///< of the vector
  double rate_hz() const { return rate_hz_; }

 private:
  static constexpr std::size_t kPlaces = 512;  // 25 ms at 20 kHz
  double rate_hz_ = 1, metres_per_count_ = 0;
  std::uint64_t expected_ = 0, ticks_ = 0, lost_ = 0, late_ = 0, blind_ = 0;
  std::uint64_t gated_ = 0, playing_ = 0, off_ = 0;
  LimitCounts limits_;
  double from_m_ = -INFINITY, to_m_ = INFINITY;
  std::uint64_t second_from_ = 0, late_before_ = 0;
  double late_part_ = 0, mean_square_ = 0, share_ = 0, peak_v_ = 0, force_peak_n_ = 0;
  std::int64_t count_ = 0, least_ = INT64_MAX, greatest_ = INT64_MIN;  // continue beyond 2^31
  schema::SessionTick last_;
  std::array<std::int32_t, kPlaces> counts_{};
};

}  // namespace tacto::playback
