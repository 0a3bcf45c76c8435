// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/noise_shape.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

// Share of the constant noise in the power, at frequencies where |H| equals its RMS.
constexpr double kConstantParts[] = {1, 0.9, 0.5, 0.1, 0.01, 1e-3, 0};
constexpr double kRoundingPart = 1e-15;  // rounding error of an exact response, relative

struct NoiseShape {
  std::vector<double> powers;  // powers of the noise before multiplication by `scale`
  double scale = 0;
  double unlikeliness = 0;  // -2 log likelihood, with the most likely scale
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
