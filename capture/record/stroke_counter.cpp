// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/stroke_counter.hpp"

#include <cmath>

namespace tacto::capture {

void StrokeCounter::begin(double position_m) {
  from_m_ = furthest_m_ = position_m;
  furthest_frame_ = frame_;
  direction_ = 0;
  stand(position_m);
}

void StrokeCounter::stand(double position_m) {
  left_m_ = position_m;
  left_frame_ = frame_;
  load_sum_n_ = 0;
  clipped_ = 0;
  reached_ = before_ = {position_m, frame_, 0, 0};
}

void StrokeCounter::reach(double position_m) {
  before_ = reached_;
  reached_ = {position_m, frame_, load_sum_n_, clipped_};
}

// If the last step took long, it is tremor at the end of the stroke, and the step before it counts.
const StrokeCounter::Step& StrokeCounter::last_step() const {
  const bool was_slow = static_cast<double>(reached_.frame - before_.frame) > kStopped_s * rate_hz_;
  return was_slow && before_.frame > left_frame_ ? before_ : reached_;
}

void StrokeCounter::end() {
  const Step& last = last_step();
  const std::uint64_t frames = last.frame - left_frame_;
  if (std::abs(furthest_m_ - from_m_) < kShortest_m || frames == 0) return;
  const double length_m = std::abs(last.at_m - left_m_);
  const auto count = static_cast<double>(frames);
  strokes_.push_back({left_frame_, frames, length_m, direction_, length_m / count * rate_hz_,
                      last.load_n / count, last.clipped});
}

void StrokeCounter::finish() {
  if (static_cast<double>(frame_ - reached_.frame) < kStopped_s * rate_hz_) return;
  end();
  begin(furthest_m_);
}

void StrokeCounter::add(double position_m, double normal_n, std::uint64_t clipped) {
  if (frame_ == 0) begin(position_m);
  const double advance_m = (position_m - furthest_m_) * direction_;
  load_sum_n_ += normal_n;
  clipped_ += clipped;
  if (direction_ == 0 && std::abs(position_m - from_m_) <= kStill_m) stand(position_m);
  if (direction_ == 0 && std::abs(position_m - from_m_) >= kTurn_m)
    direction_ = position_m > from_m_ ? 1 : -1;
  if (direction_ != 0 && (position_m - furthest_m_) * direction_ > 0) {
    furthest_m_ = position_m;
    furthest_frame_ = frame_;
    if ((position_m - reached_.at_m) * direction_ >= kStill_m) reach(position_m);
  }
  const bool turned = direction_ != 0 && advance_m <= -kTurn_m;
  const bool rests = static_cast<double>(frame_ - furthest_frame_) > kRest_s * rate_hz_;
  if (turned || rests) {
    end();
    begin(position_m);
  }
  ++frame_;
}

}  // namespace tacto::capture
