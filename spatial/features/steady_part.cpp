// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/steady_part.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "spatial/numbers/band_at.hpp"
#include "spatial/numbers/robust_statistics.hpp"

namespace tacto::spatial {
namespace {

using schema::BandPoint;
using schema::Texture;

constexpr std::size_t kSpeedPlaces = 1000;

double median_high(const std::vector<BandPoint>& bands) {
  std::vector<double> highs;
  for (const BandPoint& band : bands) highs.push_back(band.high_per_m);
  return median_of(highs);
}

// The speed's factor is the factor of either limit; the upper limit is never 0.
bool steady(const BandPoint& band, double usual_high_per_m) {
  const double factor = band.high_per_m / usual_high_per_m;
  return factor <= kSteadyFactor && factor >= 1 / kSteadyFactor;
}

// First and last index of the longest run.
std::pair<std::size_t, std::size_t> longest_run(const std::vector<BandPoint>& bands,
                                                double usual_high_per_m) {
  std::pair<std::size_t, std::size_t> longest{0, 0};
  for (std::size_t i = 0; i < bands.size(); ++i) {
    std::size_t last = i;
    while (last < bands.size() && steady(bands[last], usual_high_per_m)) ++last;
    if (last > i && last - 1 - i > longest.second - longest.first) longest = {i, last - 1};
    i = last;
  }
  return longest;
}

std::vector<BandPoint> cut_band(const std::vector<BandPoint>& band, double from_m, double to_m) {
  std::vector<BandPoint> cut{band_at(band, from_m)};
  for (const BandPoint& point : band)
    if (point.position_m > from_m && point.position_m < to_m) cut.push_back(point);
  cut.push_back(band_at(band, to_m));
  cut.front().position_m = from_m;
  cut.back().position_m = to_m;
  for (BandPoint& point : cut) point.position_m -= from_m;
  return cut;
}

SteadyPart cut(const Texture& texture, double from_m, double to_m) {
  const double pitch_m = texture.signal.pitch_m;
  const auto first = static_cast<std::size_t>(std::ceil(from_m / pitch_m * (1 - 1e-12)));
  const auto last =
      std::min(texture.signal.values.size() - 1, static_cast<std::size_t>(to_m / pitch_m * (1 + 1e-12)));
  SteadyPart part{static_cast<double>(first) * pitch_m, static_cast<double>(last) * pitch_m, texture};
  const auto begin = texture.signal.values.begin();
  part.texture.signal.values.assign(begin + static_cast<std::ptrdiff_t>(first),
                                    begin + static_cast<std::ptrdiff_t>(last) + 1);
  part.texture.valid_band = cut_band(texture.valid_band, part.from_m, part.to_m);
  return part;
}

}  // namespace

SteadyPart steady_part(const Texture& texture) {
  const double length_m = texture.signal.length_m();
  if (texture.valid_band.empty()) return {0, length_m, texture};
  std::vector<BandPoint> bands;
  for (std::size_t i = 0; i < kSpeedPlaces; ++i)
    bands.push_back(band_at(texture.valid_band, length_m * static_cast<double>(i) / (kSpeedPlaces - 1)));
  const auto [first, last] = longest_run(bands, median_high(bands));
  return cut(texture, length_m * static_cast<double>(first) / (kSpeedPlaces - 1),
             length_m * static_cast<double>(last) / (kSpeedPlaces - 1));
}

}  // namespace tacto::spatial
