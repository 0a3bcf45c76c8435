// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/finger_path.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::firmware_host {
namespace {

// A hand's speed and load wander slowly: below about 1 Hz. Our choice.
constexpr double kWanderKnotS = 0.25;
constexpr double kSlowestFactor = 0.2;   // a wandering finger does not stop or turn
constexpr double kFullPressSpeed = 0.6;  // of the plan's speed: from there on the load is the full load
constexpr double kArrivedM = 0.1e-6;

}  // namespace

FingerPath::FingerPath(const StrokePlan& plan, double step_s, Random random)
    : plan_(plan),
      step_s_(step_s),
      acceleration_mps2_(plan.speed_mps * plan.speed_mps / (2 * plan.ramp_m)),
      wander_(random, kWanderKnotS),
      rest_left_s_(plan.rest_s),
      place_{plan.from_m, 0, plan.resting_press} {}

// The square root limits the speed so that the finger can stop at the end of the stroke.
double FingerPath::target_speed_mps(double remaining_m) {
  const double factor = std::max(kSlowestFactor, 1 + plan_.wander * wander_.at(time_s_));
  return std::min(plan_.speed_mps * factor, std::sqrt(2 * acceleration_mps2_ * remaining_m));
}

double FingerPath::press() const {
  const double going = std::min(1.0, speed_mps_ / (kFullPressSpeed * plan_.speed_mps));
  return plan_.resting_press + (1 - plan_.resting_press) * going;
}

void FingerPath::arrive(double target_m) {
  place_.position_m = target_m;
  speed_mps_ = 0;
  rest_left_s_ = plan_.rest_s;
  ++strokes_done_;
}

void FingerPath::go(double target_m) {
  const double remaining_m = std::abs(target_m - place_.position_m);
  speed_mps_ = std::min(target_speed_mps(remaining_m), speed_mps_ + acceleration_mps2_ * step_s_);
  if (remaining_m <= std::max(kArrivedM, speed_mps_ * step_s_)) return arrive(target_m);
  place_.speed_mps = target_m < place_.position_m ? -speed_mps_ : speed_mps_;
  place_.position_m += place_.speed_mps * step_s_;
}

FingerPlace FingerPath::step() {
  time_s_ += step_s_;
  rest_left_s_ -= step_s_;
  place_.speed_mps = 0;
  if (rest_left_s_ <= 0 && !finished()) go(strokes_done_ % 2 == 0 ? plan_.to_m : plan_.from_m);
  place_.press = press();
  return place_;
}

}  // namespace tacto::firmware_host
