// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/psychometric_function.hpp"

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>

namespace tacto::analysis {

double scaled_level(Shape shape, double level) {
  return shape == Shape::weibull ? std::log(level) : level;
}

double level_of(Shape shape, double scaled) {
  return shape == Shape::weibull ? std::exp(scaled) : scaled;
}

std::pair<double, double> standard_function(Shape shape, double z) {
  if (shape == Shape::normal)
    return {0.5 * std::erfc(-z / std::numbers::sqrt2), 0.5 * std::erfc(z / std::numbers::sqrt2)};
  if (shape == Shape::logistic) return {1 / (1 + std::exp(-z)), 1 / (1 + std::exp(z))};
  const double exponent = -std::numbers::ln2 * std::exp(z);
  return {-std::expm1(exponent), std::exp(exponent)};
}

double standard_quantile(Shape shape, double part) {
  if (shape == Shape::normal) return boost::math::quantile(boost::math::normal(), part);
  if (shape == Shape::logistic) return std::log(part / (1 - part));
  return std::log(-std::log1p(-part) / std::numbers::ln2);
}

double PsychometricFunction::operator()(double level) const {
  const double z = (scaled_level(shape, level) - centre) / spread;
  return low() + (1 - low() - lapse) * standard_function(shape, z).first;
}

double PsychometricFunction::level_at(double part) const {
  return level_of(shape, centre + spread * standard_quantile(shape, part));
}

}  // namespace tacto::analysis
