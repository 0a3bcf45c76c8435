// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/reference/exact_band_pass.hpp"

#include <cmath>
#include <numbers>

namespace tacto::spatial::reference {
namespace {

// cos and sin of 2 pi m / n for all m, so that the sums compute no sines.
struct Circle {
  explicit Circle(std::size_t n) : cosine(n), sine(n) {
    for (std::size_t m = 0; m < n; ++m) {
      const long double angle =
          2 * std::numbers::pi_v<long double> * static_cast<long double>(m) / static_cast<long double>(n);
      cosine[m] = std::cos(angle);
      sine[m] = std::sin(angle);
    }
  }
  std::vector<long double> cosine, sine;
};

void add_frequency(std::span<const double> values, const Circle& circle, std::size_t k,
                   std::vector<long double>& sum) {
  const std::size_t n = values.size();
  long double real = 0, imaginary = 0;
  for (std::size_t i = 0; i < n; ++i) {
    real += values[i] * circle.cosine[k * i % n];
    imaginary += values[i] * circle.sine[k * i % n];
  }
  // Each frequency except 0 and half the rate has a counterpart of the same amplitude at the negative
  // frequency.
  const long double weight = (k == 0 || 2 * k == n ? 1.0L : 2.0L) / static_cast<long double>(n);
  for (std::size_t i = 0; i < n; ++i)
    sum[i] += weight * (real * circle.cosine[k * i % n] + imaginary * circle.sine[k * i % n]);
}

}  // namespace

std::vector<double> exact_band_pass(std::span<const double> values, double sample_rate_hz, Band band) {
  const Circle circle(values.size());
  std::vector<long double> sum(values.size(), 0.0L);
  for (std::size_t k = 0; 2 * k <= values.size(); ++k)
    if (band.contains(static_cast<double>(k) * sample_rate_hz / static_cast<double>(values.size())))
      add_frequency(values, circle, k, sum);
  return {sum.begin(), sum.end()};
}

}  // namespace tacto::spatial::reference
