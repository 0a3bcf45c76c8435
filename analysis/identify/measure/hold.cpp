// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/hold.hpp"

#include <cmath>
#include <numbers>

namespace tacto::analysis {
namespace {

constexpr int kImages = 3;

std::complex<double> hold_of(double frequency_hz, double rate_hz) {
  const double turn = std::numbers::pi * frequency_hz / rate_hz;
  return std::polar(turn == 0 ? 1 : std::sin(turn) / turn, -turn);
}

}  // namespace

std::complex<double> hold_factor(const Response& response, double frequency_hz, double rate_hz) {
  std::complex<double> sum = 0;
  for (int k = -kImages; k <= kImages; ++k) {
    const double image_hz = frequency_hz + k * rate_hz;
    sum += response(image_hz) * hold_of(image_hz, rate_hz);
  }
  return sum / response(frequency_hz);
}

BodeData without_hold(BodeData data, const Response& response) {
  if (!(data.held_rate_hz > 0)) return data;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto factor = hold_factor(response, data.frequency_hz[i], data.held_rate_hz);
    data.response[i] /= factor;
    if (data.has_noise()) data.noise[i] /= std::abs(factor);
  }
  data.held_rate_hz = 0;
  return data;
}

}  // namespace tacto::analysis
