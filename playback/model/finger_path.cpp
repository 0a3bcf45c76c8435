// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/finger_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "spatial/dsp/resample/hermite.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;

namespace {

// The segment's derivative is a parabola through its values at u = 0, 1/2 and 1: it is greatest at one of the
// ends or at the apex.
double greatest_slope(const spatial::HermiteSegment& segment) {
  const double start = segment.derivative(0), middle = segment.derivative(0.5), end = segment.derivative(1);
  const double curvature = start - 2 * middle + end;
  double greatest = std::max(std::abs(start), std::abs(end));
  if (curvature == 0) return greatest;
  const double apex = std::clamp(0.5 + (start - end) / (4 * curvature), 0.0, 1.0);
  return std::max(greatest, std::abs(segment.derivative(apex)));
}

}  // namespace

FingerPath finger_path_of(const schema::TimeSignal& position) {
  FingerPath path{{}, position.values};
  path.time_s.reserve(position.values.size());
  for (std::size_t i = 0; i < position.values.size(); ++i) path.time_s.push_back(position.time_s(i));
  return path;
}

schema::Result<void> check_finger_path(const FingerPath& path) {
  if (path.time_s.size() != path.position_m.size() || path.time_s.size() < 2)
    return fail(ErrorKind::unsuitable,
                "a finger path needs at least 2 knots, each with a time and a position", "path");
  for (std::size_t i = 0; i < path.time_s.size(); ++i) {
    if (!std::isfinite(path.time_s[i]) || !std::isfinite(path.position_m[i]))
      return fail(ErrorKind::unsuitable, "time or position is not a finite number",
                  fmt::format("path, knot {}", i));
    if (i > 0 && path.time_s[i] <= path.time_s[i - 1])
      return fail(ErrorKind::unsuitable, "the time does not increase", fmt::format("path, knot {}", i));
  }
  return {};
}

std::vector<double> positions_along(const FingerPath& path, double rate_hz, std::size_t samples) {
  std::vector<double> time_s(samples), position_m(samples);
  for (std::size_t i = 0; i < samples; ++i)
    time_s[i] = std::min(path.time_s.front() + static_cast<double>(i) / rate_hz, path.time_s.back());
  spatial::HermiteCurve(path.time_s, path.position_m).evaluate_sorted(time_s, position_m);
  return position_m;
}

double greatest_speed_mps(const FingerPath& path) {
  const spatial::HermiteCurve curve(path.time_s, path.position_m);
  double greatest = 0;
  for (std::size_t i = 0; i + 1 < path.time_s.size(); ++i)
    greatest = std::max(greatest, greatest_slope(curve.segment(i)) / (path.time_s[i + 1] - path.time_s[i]));
  return greatest;
}

}  // namespace tacto::playback
