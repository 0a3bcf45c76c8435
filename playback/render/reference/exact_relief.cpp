// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_relief.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware-host/core/kernel/level_of_detail.hpp"

namespace tacto::playback {
namespace {

// The cubic B-spline and its derivative, at a distance in samples.
double spline(double x) {
  const double a = std::abs(x);
  return a >= 2 ? 0 : a >= 1 ? std::pow(2 - a, 3) / 6 : 2.0 / 3 - a * a + a * a * a / 2;
}
double spline_slope(double x) {
  const double a = std::abs(x), way = x < 0 ? -1 : 1;
  return a >= 2 ? 0 : a >= 1 ? -way * (2 - a) * (2 - a) / 2 : way * (1.5 * a * a - 2 * a);
}

}  // namespace

SplineValue spline_of(const ReliefLevel& level, double x, double y) {
  const auto held = [](double at, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(count - 1)));
  };
  SplineValue at;
  for (double j = std::floor(y) - 1; j <= std::floor(y) + 2; ++j)
    for (double i = std::floor(x) - 1; i <= std::floor(x) + 2; ++i) {
      const double c =
          double{level.coefficients[held(j, level.rows) * level.columns + held(i, level.columns)]};
      at.value += c * spline(x - i) * spline(y - j);
      at.by_x += c * spline_slope(x - i) * spline(y - j);
      at.by_y += c * spline(x - i) * spline_slope(y - j);
    }
  return at;
}

double place_on_level(const Relief& relief, const ReliefLevel& level, int axis, double from_centre_m) {
  const auto all = static_cast<double>(axis == 0 ? relief.columns : relief.rows),
             count = static_cast<double>(axis == 0 ? level.columns : level.rows);
  return ((from_centre_m - relief.centre_m[axis]) / relief.pitch_m + all / 2) * count / all - 0.5;
}

double level_at(const Relief& relief, double passed_mps, double rate_hz) {
  const double per_tick = passed_mps * relief.highest_per_m / rate_hz;
  const core::Detail detail = core::detail_at(static_cast<float>(per_tick * 2 * std::numbers::sqrt2));
  return detail.coarser + double{detail.fade};
}

double played_share(double cycles_per_tick) {
  const double s = std::clamp(8 * (cycles_per_tick - 0.375), 0.0, 1.0);
  return 1 - s * s * (3 - 2 * s);
}

SlopeOfMap exact_slope(const Relief& relief, double along_m, double across_m, double passed_mps,
                       double rate_hz) {
  const double played = level_at(relief, passed_mps, rate_hz);
  SlopeOfMap slope;
  for (std::size_t n = 0; n < relief.levels.size(); ++n) {
    const double weight = std::max(0.0, 1 - std::abs(static_cast<double>(n) - played));
    if (weight == 0) continue;
    const ReliefLevel& level = relief.levels[n];
    const SplineValue at = spline_of(level, place_on_level(relief, level, 0, along_m),
                                     place_on_level(relief, level, 1, across_m));
    slope.along_columns += weight * at.by_x * static_cast<double>(level.columns) /
                           (static_cast<double>(relief.columns) * relief.pitch_m);
    slope.along_rows += weight * at.by_y * static_cast<double>(level.rows) /
                        (static_cast<double>(relief.rows) * relief.pitch_m);
  }
  return slope;
}

}  // namespace tacto::playback
