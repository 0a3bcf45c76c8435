// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/ridge_contact.hpp"

#include <algorithm>

#include "firmware-host/sim/physics/random.hpp"

namespace tacto::firmware_host {
namespace {

std::vector<double> ridge_offsets(const FingerParameters& finger, std::uint64_t seed) {
  Random random(seed, 7);
  const auto count =
      std::max<std::size_t>(1, static_cast<std::size_t>(finger.patch_m / finger.ridge_spacing_m));
  std::vector<double> offsets;
  for (std::size_t i = 0; i < count; ++i) {
    const double steps = static_cast<double>(i) - static_cast<double>(count - 1) / 2;
    offsets.push_back(finger.ridge_spacing_m * (steps + finger.ridge_jitter * random.normal()));
  }
  return offsets;
}

}  // namespace

RidgeContact::RidgeContact(const FingerParameters& finger, const HeightProfile& profile, std::uint64_t seed)
    : profile_(softened(profile, finger.ridge_width_m)),
      stiffness_n_per_m_(finger.ridge_stiffness_n_per_m),
      offsets_m_(ridge_offsets(finger, seed)),
      under_(offsets_m_.size()) {}

// Newton's method on the load as a function of the base's height, which is piecewise linear, convex and
// decreasing: from the second step on it approaches from below and ends exactly, after at most one step per
// ridge.
double RidgeContact::base_height_m(double load_n) const {
  double base_m = base_m_;
  for (std::size_t step = 0; step <= under_.size() + 1; ++step) {
    double touching = 0, sum_m = 0;
    for (const SurfacePoint& point : under_) {
      if (point.height_m <= base_m) continue;
      touching += 1;
      sum_m += point.height_m;
    }
    const double next = touching > 0 ? (sum_m - load_n / stiffness_n_per_m_) / touching : base_m - 1;
    if (next == base_m) break;
    base_m = next;
  }
  return base_m;
}

double RidgeContact::slope_force_n(double x_m, double load_n) {
  if (!(load_n > 0)) return 0;
  for (std::size_t i = 0; i < offsets_m_.size(); ++i) under_[i] = profile_.at(x_m + offsets_m_[i]);
  base_m_ = base_height_m(load_n);
  double force_n = 0;
  for (const SurfacePoint& point : under_)
    force_n += stiffness_n_per_m_ * std::max(0.0, point.height_m - base_m_) * point.slope;
  return force_n;
}

}  // namespace tacto::firmware_host
