// SPDX-License-Identifier: GPL-3.0-or-later
// How the finger's bone moves along the surface.
#pragma once

#include "firmware-host/sim/physics/spline_noise.hpp"

namespace tacto::firmware_host {

/// Strokes there and back between two places, with rests before, between and after. A hand that rests or
/// turns eases its load; with the full load the pulp would stick until it breaks away with a jump that clips
/// the transducer.
struct StrokePlan {
  double from_m = 0;
  double to_m = 0;
  double speed_mps = 0.05;
  int strokes = 2;             ///< odd ones go from `from_m` to `to_m`, even ones back
  double wander = 0.1;         ///< RMS of the speed about its mean, as a fraction
  double rest_s = 0.1;         ///< before the first stroke and between two
  double ramp_m = 2e-3;        ///< distance over which the finger comes to speed
  double resting_press = 0.1;  ///< part of the load that is left where the finger stands
};

struct FingerPlace {
  double position_m = 0;
  double speed_mps = 0;  ///< constant over the step that ended here
  double press = 1;      ///< part of the full load
};

/// The path of a plan, step by step. Never leaves [from_m, to_m]; after the last stroke the finger stays.
class FingerPath {
 public:
  FingerPath(const StrokePlan& plan, double step_s, Random random);

  /// The place one step later.
  FingerPlace step();
  FingerPlace place() const { return place_; }
  bool finished() const { return strokes_done_ == plan_.strokes; }

 private:
  double target_speed_mps(double remaining_m);
  void arrive(double target_m);
  void go(double target_m);
  double press() const;

  StrokePlan plan_;
  double step_s_;
  double acceleration_mps2_;
  SplineNoise wander_;
  double time_s_ = 0;
  double rest_left_s_;
  double speed_mps_ = 0;
  int strokes_done_ = 0;
  FingerPlace place_;
};

}  // namespace tacto::firmware_host
