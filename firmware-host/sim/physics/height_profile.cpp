// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/height_profile.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::firmware_host {
namespace {

// 1 pm: far below any perceptible height and far above rounding errors, so that the last bit of a sine, which
// depends on the processor, makes no difference between machines.
constexpr double kHeightStepM = 1e-12;

double rounded(double height_m) {
  return std::floor(height_m / kHeightStepM + 0.5) * kHeightStepM;
}

double slope_at(const std::vector<double>& heights, double pitch_m, std::size_t i) {
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t after = std::min(i + 1, heights.size() - 1);
  return (heights[after] - heights[before]) / (static_cast<double>(after - before) * pitch_m);
}

// Mean over 2 reach + 1 neighbours; the end values are repeated beyond the ends.
std::vector<double> running_mean(const std::vector<double>& values, std::size_t reach) {
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  const auto r = static_cast<std::ptrdiff_t>(reach);
  const auto held = [&](std::ptrdiff_t i) {
    return values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
  };
  double sum = 0;
  for (std::ptrdiff_t i = -r; i <= r; ++i) sum += held(i);
  std::vector<double> means;
  means.reserve(values.size());
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    means.push_back(sum / static_cast<double>(2 * reach + 1));
    sum += held(i + r + 1) - held(i - r);
  }
  return means;
}

}  // namespace

HeightProfile::HeightProfile(double pitch_m, const std::vector<double>& heights_m)
    : pitch_m_(pitch_m), points_per_m_(1 / pitch_m), last_(static_cast<double>(heights_m.size() - 1)) {
  std::vector<double> heights(heights_m.size());
  std::transform(heights_m.begin(), heights_m.end(), heights.begin(), rounded);
  points_.reserve(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i)
    points_.push_back({heights[i], slope_at(heights, pitch_m, i)});
}

double HeightProfile::length_m() const {
  return last_ * pitch_m_;
}

std::vector<double> HeightProfile::heights_m() const {
  std::vector<double> heights;
  heights.reserve(points_.size());
  for (const SurfacePoint& point : points_) heights.push_back(point.height_m);
  return heights;
}

HeightProfile softened(const HeightProfile& profile, double width_m) {
  const auto reach = static_cast<std::size_t>(std::floor(width_m / profile.pitch_m() / 2 + 0.5));
  std::vector<double> heights = profile.heights_m();
  for (int i = 0; i < 3; ++i) heights = running_mean(heights, reach);
  return {profile.pitch_m(), heights};
}

}  // namespace tacto::firmware_host
