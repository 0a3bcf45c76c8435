// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/valid_band.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tacto::spatial {
namespace {

constexpr double kSpacing_m = 1e-4;
constexpr double kTolerance = 0.01;
constexpr std::size_t kLongestLine =
    200;  // points between two that are kept: limits the search for the next one
// Keeps k = f / v finite where the creep of a long stop is below the resolution of a double.
constexpr double kSlowest_mps = 1e-12;

constexpr double kMinResolutions = 100;
constexpr double kLongest_s = 0.1;

// Whether linear interpolation of k = f / v between points i and j is accurate for all points between them.
bool is_linear(const SpeedProfile& profile, const std::vector<double>& speed_mps, std::size_t i,
               std::size_t j) {
  const auto slowness = [&](std::size_t p) { return 1 / speed_mps[p]; };
  const double from_m = profile.position_m[i], length_m = profile.position_m[j] - from_m;
  for (std::size_t p = i + 1; p < j; ++p) {
    const double u = (profile.position_m[p] - from_m) / length_m;
    const double line = slowness(i) + u * (slowness(j) - slowness(i));
    if (std::abs(line - slowness(p)) > kTolerance * slowness(p)) return false;
  }
  return true;
}

bool both_linear(const SpeedProfile& profile, std::size_t i, std::size_t j) {
  return is_linear(profile, profile.speed_mps, i, j) && is_linear(profile, profile.fastest_mps, i, j);
}

}  // namespace

SpeedWindows speed_windows(double resolution_m, double least, Band band, double sample_rate_hz) {
  const double half_period = std::min(0.5 / band.low_hz, kLongest_s) * sample_rate_hz;  // infinite at 0 Hz
  const double period = std::min(sample_rate_hz / band.high_hz, least);
  return {std::max(least, half_period), std::max(period, 2.0), kMinResolutions * resolution_m};
}

LocalSpeed::LocalSpeed(const MonotonePath& path, double sample_rate_hz, const SpeedWindows& windows)
    : path_(path),
      way_(path.sample, path.way_m),
      sample_(path.sample, path.way_m),
      sample_rate_hz_(sample_rate_hz),
      windows_(windows) {}

LocalSpeed::Advance LocalSpeed::around(double sample, double window) const {
  const double before = std::max(sample - window / 2, path_.sample.front());
  const double after = std::min(sample + window / 2, path_.sample.back());
  return {way_(after) - way_(before), after - before};
}

double LocalSpeed::at(double way_m) const {
  const Advance whole = around(sample_(way_m), windows_.longest);
  return std::max(whole.way_m / whole.samples * sample_rate_hz_, kSlowest_mps);
}

double LocalSpeed::fastest_at(double way_m) const {
  const double sample = sample_(way_m);
  const double fastest = at(way_m);
  for (double window = windows_.shortest; window < windows_.longest; window *= 2) {
    const Advance part = around(sample, window);
    if (part.way_m >= windows_.min_distance_m)
      return std::max(fastest, part.way_m / part.samples * sample_rate_hz_);
  }
  return fastest;
}

std::vector<double> LocalSpeed::stops_m() const {
  std::vector<double> stops;
  for (std::size_t i = 1; i < path_.sample.size(); ++i)
    if (path_.sample[i] - path_.sample[i - 1] > windows_.longest)
      stops.push_back(std::midpoint(path_.way_m[i - 1], path_.way_m[i]));
  return stops;
}

SpeedProfile speed_profile(const LocalSpeed& speed, double origin_m, double length_m, int direction) {
  const auto steps = static_cast<std::size_t>(std::ceil(length_m / kSpacing_m));
  SpeedProfile profile;
  for (std::size_t i = 0; i <= steps; ++i)
    profile.position_m.push_back(std::min(static_cast<double>(i) * kSpacing_m, length_m));
  for (const double stop_m : speed.stops_m())
    if (const double at_m = direction * stop_m - origin_m; at_m > 0 && at_m < length_m)
      profile.position_m.push_back(at_m);
  std::ranges::sort(profile.position_m);
  const auto repeated = std::ranges::unique(profile.position_m);
  profile.position_m.erase(repeated.begin(), repeated.end());
  for (const double at_m : profile.position_m) {
    profile.speed_mps.push_back(speed.at(direction * (origin_m + at_m)));
    profile.fastest_mps.push_back(speed.fastest_at(direction * (origin_m + at_m)));
  }
  return profile;
}

std::vector<schema::BandPoint> valid_band(const SpeedProfile& profile, Band band) {
  const auto point = [&](std::size_t i) {
    return schema::BandPoint{profile.position_m[i], band.low_hz / profile.speed_mps[i],
                             band.high_hz / profile.fastest_mps[i]};
  };
  std::vector<schema::BandPoint> points{point(0)};
  const std::size_t last = profile.position_m.size() - 1;
  for (std::size_t i = 0; i < last;) {
    std::size_t j = i + 1;
    while (j < last && j - i < kLongestLine && both_linear(profile, i, j + 1)) ++j;
    points.push_back(point(j));
    i = j;
  }
  return points;
}

void narrow(std::span<schema::BandPoint> points, double low_per_m, double high_per_m) {
  for (schema::BandPoint& point : points) {
    point.low_per_m = std::max(point.low_per_m, low_per_m);
    point.high_per_m = std::max(point.low_per_m, std::min(point.high_per_m, high_per_m));
  }
}

schema::BandPoint band_throughout(std::span<const schema::BandPoint> band) {
  schema::BandPoint common = band.front();
  for (const schema::BandPoint& point : band) {
    common.low_per_m = std::max(common.low_per_m, point.low_per_m);
    common.high_per_m = std::min(common.high_per_m, point.high_per_m);
  }
  return common;
}

}  // namespace tacto::spatial
