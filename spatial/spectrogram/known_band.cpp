// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/known_band.hpp"

#include <algorithm>

#include "spatial/numbers/band_at.hpp"

namespace tacto::spatial {

using schema::BandPoint;
using schema::KnownBand;

namespace {

KnownBand limits_at(std::span<const BandPoint> band, double position_m) {
  const BandPoint at = band_at(band, position_m);
  return {at.low_per_m, at.high_per_m};
}

void narrow(KnownBand& common, const KnownBand& other) {
  common.low_per_m = std::max(common.low_per_m, other.low_per_m);
  common.high_per_m = std::min(common.high_per_m, other.high_per_m);
}

}  // namespace

// The limits are linear between breakpoints, so their extremes are at breakpoints or at the ends of the
// interval.
KnownBand band_along(std::span<const BandPoint> band, double from_m, double to_m) {
  KnownBand common = limits_at(band, from_m);
  narrow(common, limits_at(band, to_m));
  for (auto point = std::ranges::upper_bound(band, from_m, {}, &BandPoint::position_m);
       point != band.end() && point->position_m < to_m; ++point)
    narrow(common, {point->low_per_m, point->high_per_m});
  return common;
}

std::vector<KnownBand> known_bands(std::span<const BandPoint> band, std::span<const double> centre_m,
                                   double window_m) {
  std::vector<KnownBand> known;
  if (band.empty()) return known;
  const double reach_m = kKnownPart * window_m / 2;
  known.reserve(centre_m.size());
  for (const double centre : centre_m) known.push_back(band_along(band, centre - reach_m, centre + reach_m));
  return known;
}

}  // namespace tacto::spatial
