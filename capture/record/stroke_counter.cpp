// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/stroke_counter.hpp"

#include <cmath>

#include "data-schema/base/stroke_rule.hpp"

namespace tacto::capture {

void StrokeCounter::begin(double position_m) {
  from_m_ = furthest_m_ = position_m;
  furthest_frame_ = frame_;
  direction_ = 0;
}

void StrokeCounter::add(double position_m) {
  if (frame_ == 0) begin(position_m);
  if (direction_ == 0 && std::abs(position_m - from_m_) >= kTurn_m)
    direction_ = position_m > from_m_ ? 1 : -1;
  const double advance_m = (position_m - furthest_m_) * direction_;
  if (advance_m > 0) {
    furthest_m_ = position_m;
    furthest_frame_ = frame_;
  }
  const bool turned = direction_ != 0 && advance_m <= -kTurn_m;
  const bool rests =
      direction_ != 0 && static_cast<double>(frame_ - furthest_frame_) > schema::kStrokePause_s * rate_hz_;
  if (turned || rests) {
    strokes_ += std::abs(furthest_m_ - from_m_) >= schema::kShortestStroke_m;
    begin(turned ? furthest_m_ : position_m);
  }
  ++frame_;
}

}  // namespace tacto::capture
