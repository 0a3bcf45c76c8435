// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/known_bins.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

std::size_t bin_at(double bin, std::size_t bins) {
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins)));
}

}  // namespace

std::vector<BinRange> known_bins(const schema::Spectrogram& spectrogram) {
  const double step = spectrogram.frequency_step_per_m;
  const double least_per_m = 2 / spectrogram.window_m;
  const double edge_per_m = resolution_per_m(spectrogram);
  std::vector<BinRange> rows;
  for (std::size_t row = 0; row < spectrogram.position_m.size(); ++row) {
    const schema::KnownBand known =
        spectrogram.known.empty() ? schema::KnownBand{-edge_per_m, INFINITY} : spectrogram.known[row];
    const double low = std::ceil(std::max(known.low_per_m + edge_per_m, least_per_m) / step * (1 - 1e-12));
    const double high = std::floor((known.high_per_m - edge_per_m) / step * (1 + 1e-12)) + 1;
    const std::size_t first = bin_at(low, spectrogram.bins);
    rows.push_back({first, std::max(first, bin_at(high, spectrogram.bins))});
  }
  return rows;
}

}  // namespace tacto::spatial
