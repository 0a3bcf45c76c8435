// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/noise_shape.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

// Parts of the constant noise's power in the mix where |H| is its RMS.
constexpr double kConstantParts[] = {1, 0.9, 0.5, 0.1, 0.01, 1e-3, 0};
constexpr double kRoundingPart = 1e-15;  // an exact response leaves this much of itself

struct NoiseShape {
  std::vector<double> powers;  // of which the residuals' is `scale` times
  double scale = 0;
  double unlikeliness = 0;  // -2 log likelihood, the scale being the likeliest
};

double modelled_power(std::span<const std::complex<double>> values) {
  double sum = 0;
  for (const auto& value : values) sum += std::norm(value);
  return sum / static_cast<double>(values.size());
}

NoiseShape noise_shape(const BodeData& data, std::span<const std::complex<double>> modelled,
                       double constant_part) {
  NoiseShape shape;
  const double whole = modelled_power(modelled);
  double squares = 0, logs = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    shape.powers.push_back(constant_part * whole + (1 - constant_part) * std::norm(modelled[i]));
    squares += std::norm(data.response[i] - modelled[i]) / shape.powers[i];
    logs += 2 * std::log(shape.powers[i]);
  }
  const double values = 2 * static_cast<double>(data.size());
  shape.scale = std::max(squares / values, kRoundingPart * kRoundingPart);
  shape.unlikeliness = values * std::log(shape.scale) + logs;
  return shape;
}

}  // namespace

BodeData with_noise_of_residuals(BodeData data, std::span<const std::complex<double>> modelled,
                                 std::size_t parameters) {
  NoiseShape best = noise_shape(data, modelled, kConstantParts[0]);
  for (const double part : kConstantParts) {
    NoiseShape shape = noise_shape(data, modelled, part);
    if (shape.unlikeliness < best.unlikeliness) best = std::move(shape);
  }
  const double values = 2 * static_cast<double>(data.size());
  const double scale = best.scale * values / (values - static_cast<double>(parameters));
  data.noise.clear();
  for (const double power : best.powers) data.noise.push_back(std::sqrt(scale * power));
  data.noise_from_residuals = true;
  return data;
}

}  // namespace tacto::analysis
