// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/finger_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "spatial/dsp/resample/hermite.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

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

bool ends_where_it_began(const FingerPath& path) {
  constexpr double kMeetM = 1e-6;
  return std::abs(path.position_m.back() - path.position_m.front()) < kMeetM;
}

// The last knot of a pass is the first one of the next.
Result<FingerPath> repeated(const FingerPath& path, std::size_t times) {
  constexpr std::size_t kMostKnots = 1 << 24;
  const std::size_t knots = path.time_s.size(), spans = knots - 1;
  if (times > 1 && times > kMostKnots / knots)
    return fail(ErrorKind::usage,
                fmt::format("{} knots, repeated {} times, are more than {}", knots, times, kMostKnots),
                "--repeat", "repeat the path less often, or give it fewer knots");
  const bool returns = !ends_where_it_began(path);
  FingerPath all = path;
  for (std::size_t pass = 1; pass < times; ++pass) {
    const double from_s = path.time_s.front() + static_cast<double>(pass) * path.duration_s();
    const bool back = returns && pass % 2 == 1;
    for (std::size_t i = 1; i <= spans; ++i) {
      const std::size_t knot = back ? spans - i : i;
      const double since_s =
          back ? path.time_s.back() - path.time_s[knot] : path.time_s[knot] - path.time_s.front();
      all.time_s.push_back(from_s + since_s);
      all.position_m.push_back(path.position_m[knot]);
      if (!path.normal_force_n.empty()) all.normal_force_n.push_back(path.normal_force_n[knot]);
    }
  }
  return all;
}

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
