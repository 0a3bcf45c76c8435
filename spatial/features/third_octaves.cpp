// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/third_octaves.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::spatial {
namespace {

using schema::ThirdOctaveBand;

// IEC 61260-1:2014, 5.2 and 5.5: a factor G^(1/6) on each side of the middle, with G = 10^(3/10).
const double kHalfBand = std::pow(10, 0.05);
constexpr double kReference_per_m = 1000;

ThirdOctaveBand whole_band(int number) {
  ThirdOctaveBand band;
  band.number = number;
  band.centre_per_m = kReference_per_m * std::pow(10, number / 10.0);
  band.low_per_m = band.centre_per_m / kHalfBand;
  band.high_per_m = band.centre_per_m * kHalfBand;
  return band;
}

// The band that contains a frequency; the lower edge of band n is 10^((n - 0.5) / 10).
int band_of(double frequency_per_m) {
  return static_cast<int>(std::lround(10 * std::log10(frequency_per_m / kReference_per_m)));
}

}  // namespace

std::vector<ThirdOctaveBand> third_octaves(double low_per_m, double high_per_m) {
  std::vector<ThirdOctaveBand> bands;
  for (int number = band_of(low_per_m); number <= band_of(high_per_m); ++number) {
    ThirdOctaveBand band = whole_band(number);
    const double from = std::max(band.low_per_m, low_per_m), to = std::min(band.high_per_m, high_per_m);
    if (!(from < to)) continue;
    constexpr double kRounding = 1e-9;
    band.partial = from > band.low_per_m * (1 + kRounding) || to < band.high_per_m * (1 - kRounding);
    bands.push_back(band);
  }
  return bands;
}

}  // namespace tacto::spatial
