// SPDX-License-Identifier: GPL-3.0-or-later
// The motion of the finger's bone along the surface.
#pragma once

#include "firmware-host/sim/physics/spline_noise.hpp"

namespace tacto::firmware_host {

/// Strokes there and back between two places, with rests before, between and after. A finger at rest or at a
/// turning point has a reduced load; with the full load the pulp would stick until it breaks away with a jump
/// that clips the transducer.
struct StrokePlan {
  double from_m = 0;
  double to_m = 0;
  double speed_mps = 0.05;
  int strokes = 2;             ///< odd ones go from `from_m` to `to_m`, even ones back
  double wander = 0.1;         ///< RMS of the speed about its mean, as a fraction
  double rest_s = 0.1;         ///< before the first stroke and between two
  double ramp_m = 2e-3;        ///< distance of the acceleration to full speed
  double resting_press = 0.1;  ///< the fraction of the load on a resting finger
};

struct FingerPlace {
  double position_m = 0;
  double speed_mps = 0;  ///< constant over the step that ended here
  double press = 1;      ///< part of the full load
};

/// The path of a plan, step by step. It stays within [from_m, to_m]; after the last stroke the finger rests.
class FingerPath {
 public:
  FingerPath(const StrokePlan& plan, double step_s, Random random);

  /// Returns the place one step later.
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
