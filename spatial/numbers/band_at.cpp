// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/numbers/band_at.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace tacto::spatial
