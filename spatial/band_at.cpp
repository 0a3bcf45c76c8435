// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/band_at.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "spatial/valid_band.hpp"

namespace tacto::spatial {

using schema::BandPoint;

BandPoint band_at(std::span<const BandPoint> band, double position_m) {
  const auto next = std::ranges::upper_bound(band, position_m, {}, &BandPoint::position_m);
  if (next == band.begin()) return band.front();
  if (next == band.end()) return band.back();
  const BandPoint& last = *std::prev(next);
  const double part = (position_m - last.position_m) / (next->position_m - last.position_m);
  return {position_m, std::lerp(last.low_per_m, next->low_per_m, part),
          std::lerp(last.high_per_m, next->high_per_m, part)};
}

// Straight between breakpoints, so the extremes of a stretch lie at its ends or at breakpoints within.
BandPoint band_along(std::span<const BandPoint> band, double from_m, double to_m) {
  const auto first = std::ranges::upper_bound(band, from_m, {}, &BandPoint::position_m);
  const auto last = std::ranges::lower_bound(band, to_m, {}, &BandPoint::position_m);
  std::vector<BandPoint> within;
  if (first < last) within.assign(first, last);
  within.push_back(band_at(band, from_m));
  within.push_back(band_at(band, to_m));
  return band_throughout(within);
}

}  // namespace tacto::spatial
