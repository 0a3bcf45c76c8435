// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/stroke_counter.hpp"

#include <cmath>

namespace tacto::capture {

void StrokeCounter::begin(double position_m) {
  from_m_ = furthest_m_ = position_m;
  from_frame_ = furthest_frame_ = frame_;
  load_sum_n_ = load_until_furthest_n_ = 0;
  clipped_ = clipped_until_furthest_ = 0;
  direction_ = 0;
}

void StrokeCounter::end() {
  const double length_m = std::abs(furthest_m_ - from_m_);
  const std::uint64_t frames = furthest_frame_ - from_frame_;
  if (length_m < kShortest_m || frames == 0) return;
  const auto count = static_cast<double>(frames);
  strokes_.push_back({from_frame_, frames, length_m, direction_, length_m / count * rate_hz_,
                      load_until_furthest_n_ / count, clipped_until_furthest_});
}

void StrokeCounter::add(double position_m, double normal_n, std::uint64_t clipped) {
  if (frame_ == 0) begin(position_m);
  const double gone_m = (position_m - furthest_m_) * direction_;
  if (direction_ == 0 && std::abs(position_m - from_m_) >= kTurn_m)
    direction_ = position_m > from_m_ ? 1 : -1;
  load_sum_n_ += normal_n;
  clipped_ += clipped;
  if (direction_ != 0 && (position_m - furthest_m_) * direction_ > 0) {
    furthest_m_ = position_m;
    furthest_frame_ = frame_;
    load_until_furthest_n_ = load_sum_n_;
    clipped_until_furthest_ = clipped_;
  }
  const bool turned = direction_ != 0 && gone_m <= -kTurn_m;
  const bool rests = static_cast<double>(frame_ - furthest_frame_) > kRest_s * rate_hz_;
  if (turned || rests) {
    end();
    begin(position_m);
  }
  ++frame_;
}

}  // namespace tacto::capture
