// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/smoothed_speed.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tacto::spatial {
namespace {

// Half of it on each side of a sample: short compared with a stroke's start and stop (about 0.1 s by hand or
// motor).
constexpr double kShortestWindow_s = 0.02;
constexpr double kLongestWindow_s = 0.5;
constexpr double kResolutionsInWindow = 10;

}  // namespace

std::vector<double> smoothed_speed(std::span<const double> position_m, double sample_rate_hz,
                                   std::size_t window) {
  assert(position_m.size() >= 2 && window >= 2);
  const std::size_t n = position_m.size(), half = window / 2;
  std::vector<double> speed(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i - std::min(i, half), after = std::min(i + half, n - 1);
    speed[i] =
        (position_m[after] - position_m[before]) / static_cast<double>(after - before) * sample_rate_hz;
  }
  return speed;
}

std::size_t speed_window(double resolution_m, double speed_mps, double sample_rate_hz) {
  const double enough_s = speed_mps > 0 ? kResolutionsInWindow * resolution_m / speed_mps : 0;
  const double window_s = std::clamp(enough_s, kShortestWindow_s, kLongestWindow_s);
  return std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(window_s * sample_rate_hz)));
}

}  // namespace tacto::spatial
