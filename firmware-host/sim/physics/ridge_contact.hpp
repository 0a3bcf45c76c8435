// SPDX-License-Identifier: GPL-3.0-or-later
// The contact patch: elastic skin ridges that share the load according to the height below them.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware-host/sim/physics/finger_parameters.hpp"
#include "firmware-host/sim/physics/height_profile.hpp"

namespace tacto::firmware_host {

/// Each ridge is a spring that can push but not pull: with the patch's base at height z, ridge i carries p_i
/// = max(0, k (h(x + o_i) - z)), and z is such that the sum of the p_i is the load. A ridge without load has
/// left the surface, which makes the contact nonlinear.
class RidgeContact {
 public:
  /// The profile is smoothed by the ridges' width; the positions of the ridges are random, with `seed`.
  RidgeContact(const FingerParameters& finger, const HeightProfile& profile, std::uint64_t seed);

  /// The tangential force in newtons that the ridges exert on slopes, sum of p_i h'_i, with the patch's
  /// middle at x. Friction is added to it: the friction coefficient times the load. This is the small-slope
  /// form of N tan(atan h' + atan mu); it neglects mu h' of a ridge's share. 0 if the load is not positive.
  double slope_force_n(double x_m, double load_n);

  std::size_t ridges() const { return offsets_m_.size(); }

 private:
  double base_height_m(double load_n) const;

  HeightProfile profile_;
  double stiffness_n_per_m_;
  double base_m_ = 0;  // result of the last search, start of the next
  std::vector<double> offsets_m_;
  std::vector<SurfacePoint> under_;
};

}  // namespace tacto::firmware_host
