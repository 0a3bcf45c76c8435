// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/relief/groove_series.hpp"

#include <cmath>
#include <numbers>

namespace tacto::playback {
namespace {

using schema::GrooveProfile;

constexpr double kPi = std::numbers::pi;
constexpr double kLeastPart = 1e-6;  // of the first harmonic: below the rounding of single precision

// Fourier series of profiles from -1 to 1 with their highest place at 0.
double amplitude_of(GrooveProfile profile, unsigned n) {
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

core::Grooves groove_series(const GrooveShape& shape) {
  core::Grooves grooves{};
  const double turn_m = 2 * kPi * shape.filter_m / shape.period_m;
  double first = 0;
  for (unsigned n = 1; n <= core::kMostHarmonics; ++n) {
    const double kept = std::exp(-turn_m * turn_m * n * n / 2);
    const double amplitude = shape.depth_m / 2 * amplitude_of(shape.profile, n) * kept;
    if (n == 1) first = std::abs(amplitude);
    grooves.amplitude[n - 1] = static_cast<float>(amplitude);
    if (std::abs(amplitude) > kLeastPart * first) grooves.harmonics = n;
  }
  return grooves;
}

}  // namespace tacto::playback
