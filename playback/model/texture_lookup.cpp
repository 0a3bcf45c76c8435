// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/texture_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data-schema/base/raised_cosine.hpp"
#include "spatial/dsp/resample/hermite.hpp"

namespace tacto::playback {
namespace {
constexpr double kFadeM = 1e-3;
constexpr double kLargestFadeShare = 0.1;
}  // namespace

double fade_of(double length_m) {
  return std::min(kFadeM, kLargestFadeShare * length_m);
}

TextureLookup::TextureLookup(const schema::SpaceSignal& signal, double at_m)
    : signal_(signal), at_m_(at_m), fade_m_(fade_of(signal.length_m())) {}

bool TextureLookup::contains(double position_m) const {
  return position_m >= at_m_ && position_m <= at_m_ + signal_.length_m();
}

double TextureLookup::operator()(double position_m) const {
  if (!contains(position_m)) return 0;
  const double along_m = position_m - at_m_;
  return interpolated(along_m / signal_.pitch_m) * fade(std::min(along_m, signal_.length_m() - along_m));
}

// (8 (y[+1] - y[-1]) - (y[+2] - y[-2])) / 12, times the pitch. Beyond the ends, which are faded, the end
// sample is repeated.
double TextureLookup::slope(std::size_t i) const {
  const auto& y = signal_.values;
  const std::size_t last = y.size() - 1;
  const auto before = [&](std::size_t n) { return y[i < n ? 0 : i - n]; };
  const auto after = [&](std::size_t n) { return y[std::min(i + n, last)]; };
  return (8 * (after(1) - before(1)) - (after(2) - before(2))) / 12;
}

double TextureLookup::interpolated(double grid_position) const {
  const auto& y = signal_.values;
  const auto i = std::min(static_cast<std::size_t>(std::max(grid_position, 0.0)), y.size() - 2);
  const spatial::HermiteSegment segment{y[i], y[i + 1], slope(i), slope(i + 1)};
  return segment.value(grid_position - static_cast<double>(i));
}

double TextureLookup::fade(double distance_to_end_m) const {
  if (distance_to_end_m >= fade_m_) return 1;
  return schema::rising_cosine(std::numbers::pi * distance_to_end_m / fade_m_);
}

}  // namespace tacto::playback
