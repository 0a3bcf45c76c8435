// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/windowed_sinc.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tacto::spatial {
namespace {

// Kaiser's window for -120 dB: 0.1102 (120 - 8.7).
constexpr double kSincBeta = 12.265;

double weight_at(double distance) {
  const double share = distance / static_cast<double>(WindowedSinc::kReach);
  if (std::abs(share) >= 1) return 0;
  const double turn = std::numbers::pi * distance;
  const double sinc = turn == 0 ? 1 : std::sin(turn) / turn;
  return sinc * std::cyl_bessel_i(0, kSincBeta * std::sqrt(1 - share * share)) /
         std::cyl_bessel_i(0, kSincBeta);
}

}  // namespace

WindowedSinc::WindowedSinc() : weights_((kPhases + 1) * kTaps) {
  for (std::size_t phase = 0; phase <= kPhases; ++phase) {
    const auto row = std::span(weights_).subspan(phase * kTaps, kTaps);
    const double beyond = static_cast<double>(phase) / static_cast<double>(kPhases);
    for (std::size_t tap = 0; tap < kTaps; ++tap)
      row[tap] = weight_at(beyond + static_cast<double>(kReach - 1) - static_cast<double>(tap));
    const double sum = std::accumulate(row.begin(), row.end(), 0.0);
    for (double& weight : row) weight /= sum;
  }
}

double WindowedSinc::operator()(std::span<const double> values, double place) const {
  assert(!values.empty());
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  const double before = std::clamp(std::floor(place), 0.0, static_cast<double>(last));
  const double phase = std::clamp(place - before, 0.0, 1.0) * static_cast<double>(kPhases);
  const auto row = std::min(static_cast<std::size_t>(phase), kPhases - 1);
  const double share = phase - static_cast<double>(row);
  const double* low = weights_.data() + row * kTaps;
  const auto first = static_cast<std::ptrdiff_t>(before) - static_cast<std::ptrdiff_t>(kReach - 1);
  double sum = 0;
  for (std::size_t tap = 0; tap < kTaps; ++tap) {
    const auto at = std::clamp<std::ptrdiff_t>(first + static_cast<std::ptrdiff_t>(tap), 0, last);
    sum += (low[tap] + share * (low[tap + kTaps] - low[tap])) * values[static_cast<std::size_t>(at)];
  }
  return sum;
}

}  // namespace tacto::spatial
