// SPDX-License-Identifier: GPL-3.0-or-later
// A position that was not measured, computed from a measured or a nominal speed.
#pragma once

#include <cstdint>
#include <optional>

#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// Positions frame by frame, in metres, from 0 at the first. Times are computed from the frame count, gaps
/// included: this is exact, while a sum of periods would drift.
class DerivedPosition {
 public:
  /// speed * time; the channel's derivation says "nominal: 40 mm/s".
  static DerivedPosition nominal(double speed_mps);
  /// The trapezoid rule over a speed channel. Across a gap the speed is assumed to change linearly.
  static DerivedPosition integrated(const schema::Channel& speed);

  const schema::Channel& channel() const { return channel_; }
  /// The next frame's position. `stored` is the number of the speed channel; it is ignored if the position is
  /// nominal. The rate and the gaps are those of `header`.
  double next(const schema::RecordingHeader& header, double stored);

 private:
  explicit DerivedPosition(std::string derivation);

  schema::Channel channel_;
  std::optional<double> nominal_mps_;
  double scale_ = 1, offset_ = 0;  // of the speed channel
  std::uint64_t frame_ = 0, missing_ = 0;
  std::size_t gaps_passed_ = 0;
  double last_tick_ = 0, last_mps_ = 0, position_m_ = 0;
};

}  // namespace tacto::capture
