// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/spline_noise.hpp"

#include <algorithm>

namespace tacto::firmware_host {
namespace {

// 1 / sqrt(151/315): the integral of the squared cubic B-spline is 151/315.
constexpr double kToUnitRms = 1.444333;

std::array<double, 4> cubic_b_spline(double u) {
  const double w = 1 - u;
  return {w * w * w / 6, (u * u * (3 * u - 6) + 4) / 6, (w * w * (3 * w - 6) + 4) / 6, u * u * u / 6};
}

}  // namespace

SplineNoise::SplineNoise(Random random, double knot_spacing)
    : random_(random), knots_per_unit_(1 / knot_spacing) {
  for (double& coefficient : coefficients_) coefficient = random_.normal();
}

void SplineNoise::go_to_knot(std::int64_t knot) {
  for (; knot_ < knot; ++knot_) {
    std::rotate(coefficients_.begin(), coefficients_.begin() + 1, coefficients_.end());
    coefficients_.back() = random_.normal();
  }
}

double SplineNoise::at(double place) {
  const double knots = place * knots_per_unit_;
  go_to_knot(static_cast<std::int64_t>(knots));
  const auto weights = cubic_b_spline(knots - static_cast<double>(knot_));
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * coefficients_[i];
  return sum * kToUnitRms;
}

}  // namespace tacto::firmware_host
