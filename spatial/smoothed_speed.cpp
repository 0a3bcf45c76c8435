// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/smoothed_speed.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace tacto::spatial {
namespace {

// Half of it on each side of a sample: short against a stroke's start and stop (about 0.1 s by hand or
// motor).
constexpr double kShortestWindow_s = 0.02;
constexpr double kLongestWindow_s = 0.5;
constexpr double kQuantaInWindow = 10;
constexpr double kRounding =
    1e-12;  // of the largest position: what two roundings of doubles may differ by, and more
constexpr double kEven = 0.01;  // of the moving samples: fewer changes of step are turns, not a grid

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

std::size_t speed_window(double quantum_m, double speed_mps, double sample_rate_hz) {
  const double enough_s = speed_mps > 0 ? kQuantaInWindow * quantum_m / speed_mps : 0;
  const double window_s = std::clamp(enough_s, kShortestWindow_s, kLongestWindow_s);
  return std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(window_s * sample_rate_hz)));
}

double travelling_speed(std::span<const double> speed_mps) {
  std::vector<double> speeds(speed_mps.size());
  std::ranges::transform(speed_mps, speeds.begin(), [](double v) { return std::abs(v); });
  std::ranges::sort(speeds);
  const double half_way = std::accumulate(speeds.begin(), speeds.end(), 0.0) / 2;
  double way = 0;
  for (const double speed : speeds) {
    way += speed;
    if (way >= half_way) return speed;
  }
  return 0;
}

double position_quantum(std::span<const double> position_m) {
  if (position_m.size() < 3) return 0;
  const auto [lowest, highest] = std::ranges::minmax(position_m);
  const double rounding = kRounding * std::max(std::abs(lowest), std::abs(highest));
  double smallest = std::numeric_limits<double>::infinity();
  std::size_t moving = 0, uneven = 0;
  for (std::size_t i = 2; i < position_m.size(); ++i) {
    const double step = position_m[i] - position_m[i - 1];
    const double change = std::abs(step - (position_m[i - 1] - position_m[i - 2]));
    moving += std::abs(step) > rounding;
    if (change <= rounding) continue;
    ++uneven;
    smallest = std::min(smallest, change);
  }
  return static_cast<double>(uneven) > kEven * static_cast<double>(moving) ? smallest : 0;
}

}  // namespace tacto::spatial
