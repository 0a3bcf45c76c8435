// SPDX-License-Identifier: GPL-3.0-or-later
// A surface as its height along x.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::firmware_host {

/// Height and slope (dh/dx, 1) of a surface at one place.
struct SurfacePoint {
  double height_m = 0;
  double slope = 0;
};

/// Heights on an even grid that begins at x = 0, linear between samples, constant beyond both ends.
class HeightProfile {
 public:
  /// At least two heights, in metres, `pitch_m` apart.
  HeightProfile(double pitch_m, const std::vector<double>& heights_m);

  double length_m() const;
  std::vector<double> heights_m() const;
  double pitch_m() const { return pitch_m_; }

  SurfacePoint at(double x_m) const {
    const double place = x_m * points_per_m_;
    if (!(place > 0)) return {points_.front().height_m, 0};
    if (place >= last_) return {points_.back().height_m, 0};
    const auto i = static_cast<std::size_t>(place);
    const double u = place - static_cast<double>(i);
    const SurfacePoint &a = points_[i], &b = points_[i + 1];
    return {a.height_m + u * (b.height_m - a.height_m), a.slope + u * (b.slope - a.slope)};
  }

 private:
  double pitch_m_, points_per_m_, last_;
  std::vector<SurfacePoint> points_;
};

/// The profile as a soft body follows it: smoothed by three running means, each `width_m` wide.
HeightProfile softened(const HeightProfile& profile, double width_m);

}  // namespace tacto::firmware_host
