// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/relief/groove_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware-host/core/scene/grooves.hpp"

namespace tacto::playback {
namespace {

using schema::GrooveProfile;
using schema::largest_value;

constexpr double kPi = std::numbers::pi;
constexpr double kLeastPart = 1e-6;       // of the first harmonic: below the rounding of single precision
constexpr double kStepCurvature = 0.242;  // 1 / sqrt(2 pi e): of a step of 1 smoothed by a sigma of 1
constexpr double kLongestPeriodInFilters = 76;

// Fourier series of profiles from -1 to 1 with their highest place at 0.
double amplitude_of(GrooveProfile profile, unsigned n, double duty) {
  if (profile == GrooveProfile::square && duty != 0.5) return 4 / (kPi * n) * std::sin(kPi * n * duty);
  if (n % 2 == 0) return 0;
  switch (profile) {
    case GrooveProfile::sine:
      return n == 1 ? 1 : 0;
    case GrooveProfile::triangle:
      return 8 / (kPi * kPi * n * n);
    case GrooveProfile::square:
      break;
  }
  return (n % 4 == 1 ? 4 : -4) / (kPi * n);
}

}  // namespace

std::vector<double> groove_amplitudes(GrooveProfile profile, double filter_periods, double duty) {
  const double turn = 2 * kPi * filter_periods;
  std::vector<double> amplitudes;
  for (unsigned n = 1; n <= core::kMostHarmonics; ++n)
    amplitudes.push_back(amplitude_of(profile, n, duty) / 2 * std::exp(-turn * turn * n * n / 2));
  const double least = kLeastPart * std::abs(amplitudes.front());
  while (std::abs(amplitudes.back()) <= least && amplitudes.size() > 1) amplitudes.pop_back();
  return amplitudes;
}

double largest_curvature(const std::vector<double>& amplitudes) {
  const std::size_t places = 16 * amplitudes.size();  // of half a period: 32 of the shortest one
  double largest = 0;
  for (std::size_t i = 0; i <= places; ++i) {
    const double phase = 0.5 * static_cast<double>(i) / static_cast<double>(places);
    double sum = 0;
    for (std::size_t n = 1; n <= amplitudes.size(); ++n) {
      const double turn = 2 * kPi * static_cast<double>(n);
      sum += turn * turn * amplitudes[n - 1] * std::cos(turn * phase);
    }
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

double automatic_filter_m(const schema::GroovesLayer& grooves, double stiffness_limit_n_per_m) {
  const double product = largest_value(grooves.kappa_n) * largest_value(grooves.depth_m);
  const double margin = grooves.filter_margin.value, period_m = grooves.period_m.value;
  switch (grooves.profile) {
    case GrooveProfile::sine:
      return 0;
    case GrooveProfile::triangle:
      return margin * 4 * product / (period_m * std::sqrt(2 * kPi) * stiffness_limit_n_per_m);
    case GrooveProfile::square:
      break;
  }
  return std::max(margin * std::sqrt(kStepCurvature * product / stiffness_limit_n_per_m),
                  period_m / kLongestPeriodInFilters);
}

}  // namespace tacto::playback
