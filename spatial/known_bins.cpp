// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/known_bins.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/band_at.hpp"
#include "spatial/spectrogram_summary.hpp"
#include "spatial/valid_band.hpp"

namespace tacto::spatial {
namespace {

using schema::BandPoint;

// The part of a Blackman window that passes 90 % of its power: as in the spectrogram's own mask.
constexpr double kMiddle = 0.392;

// Straight between breakpoints, so the extremes of a stretch lie at its ends or at breakpoints within.
BandPoint valid_within(std::span<const BandPoint> band, double from_m, double to_m) {
  const auto first = std::ranges::upper_bound(band, from_m, {}, &BandPoint::position_m);
  const auto last = std::ranges::lower_bound(band, to_m, {}, &BandPoint::position_m);
  std::vector<BandPoint> within;
  if (first < last) within.assign(first, last);
  within.push_back(band_at(band, from_m));
  within.push_back(band_at(band, to_m));
  return band_throughout(within);
}

std::size_t bin_at(double bin, std::size_t bins) {
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins)));
}

}  // namespace

std::vector<BinRange> known_bins(const schema::Spectrogram& spectrogram,
                                 std::span<const BandPoint> valid_band) {
  const double step = spectrogram.frequency_step_per_m;
  const double least_per_m = 2 / spectrogram.window_m;
  const double edge_per_m = resolution_per_m(spectrogram);
  const double middle_m = kMiddle * spectrogram.window_m;
  std::vector<BinRange> rows;
  for (const double centre_m : spectrogram.position_m) {
    BandPoint band{centre_m, -edge_per_m, INFINITY};
    if (!valid_band.empty())
      band = valid_within(valid_band, centre_m - middle_m / 2, centre_m + middle_m / 2);
    const double low = std::ceil(std::max(band.low_per_m + edge_per_m, least_per_m) / step * (1 - 1e-12));
    const double high = std::floor((band.high_per_m - edge_per_m) / step * (1 + 1e-12)) + 1;
    const std::size_t first = bin_at(low, spectrogram.bins);
    rows.push_back({first, std::max(first, bin_at(high, spectrogram.bins))});
  }
  return rows;
}

}  // namespace tacto::spatial
