// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/reference/exact_treated_band_pass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spatial/dsp/filter/band_kernel.hpp"

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

using Real = long double;

Real low_pass_tap(Real edge, std::size_t k, Real reach) {
  const Real n = static_cast<Real>(k);
  if (k == 0) return 2 * edge;
  return std::sin(2 * std::numbers::pi_v<Real> * edge * n) / (std::numbers::pi_v<Real> * n) *
         static_cast<Real>(kernel_window(static_cast<double>(n / reach)));
}

std::vector<Real> low_pass(double edge_hz, double sample_rate_hz, Real reach) {
  std::vector<Real> taps;
  Real sum = 0;
  for (std::size_t k = 0; static_cast<Real>(k) <= reach; ++k) {
    taps.push_back(low_pass_tap(static_cast<Real>(edge_hz) / sample_rate_hz, k, reach));
    sum += (k == 0 ? 1 : 2) * taps.back();
  }
  if (edge_hz > 0)
    for (Real& tap : taps) tap /= sum;
  return taps;
}

// Level and slope at index 0 of the line through values[0 ... count), by the normal equations.
struct Line {
  Real level, slope;
};

Line fit(const std::vector<Real>& values, std::size_t count) {
  Real n = 0, x = 0, xx = 0, y = 0, xy = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Real at = static_cast<Real>(k);
    n += 1, x += at, xx += at * at, y += values[k], xy += at * values[k];
  }
  const Real slope = (n * xy - x * y) / (n * xx - x * x);
  return {(y - slope * x) / n, slope};
}

// The continuation before the first of `values`, from the record outwards.
std::vector<Real> outwards(const std::vector<Real>& values, std::size_t padding, std::size_t baseline) {
  const Line line = fit(values, baseline);
  std::vector<Real> beyond;
  for (std::size_t k = 1; k <= padding; ++k) {
    const Real at = static_cast<Real>(k), u = at / static_cast<Real>(padding + 1);
    const Real taper = 1 - u * u * u * (10 - 15 * u + 6 * u * u);
    const Real rise = -line.slope * at + values[k] - (line.level + line.slope * at);
    beyond.push_back(line.level + taper * rise);
  }
  beyond.push_back(line.level);
  return beyond;
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

ExactTreatedBandPass::ExactTreatedBandPass(std::span<const double> values, double sample_rate_hz, Band band,
                                           double lowest_hz, double reach_s)
    : kernel_(low_pass(band.high_hz, sample_rate_hz, static_cast<Real>(reach_s) * sample_rate_hz)) {
  const auto below = low_pass(band.low_hz, sample_rate_hz, static_cast<Real>(reach_s) * sample_rate_hz);
  for (std::size_t k = 0; k < kernel_.size(); ++k) kernel_[k] -= below[k];
  const auto samples = [&](double periods) {
    return static_cast<std::size_t>(periods / lowest_hz * sample_rate_hz);
  };
  padding_ = std::min(samples(8), values.size() - 1);
  const std::size_t baseline = std::clamp<std::size_t>(samples(2), 2, values.size());
  std::vector<Real> record(values.begin(), values.end());
  extended_ = outwards(record, padding_, baseline);
  std::ranges::reverse(extended_);
  extended_.insert(extended_.end(), record.begin(), record.end());
  std::ranges::reverse(record);
  const auto after = outwards(record, padding_, baseline);
  extended_.insert(extended_.end(), after.begin(), after.end());
}

double ExactTreatedBandPass::operator()(std::size_t index) const {
  const auto last = static_cast<std::ptrdiff_t>(extended_.size()) - 1;
  const auto middle = static_cast<std::ptrdiff_t>(index + padding_ + 1);
  const auto at = [&](std::ptrdiff_t i) {
    return extended_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
  };
  Real sum = kernel_[0] * at(middle);
  for (std::size_t k = 1; k < kernel_.size(); ++k) {
    const auto step = static_cast<std::ptrdiff_t>(k);
    sum += kernel_[k] * (at(middle - step) + at(middle + step));
  }
  return static_cast<double>(sum);
}

}  // namespace tacto::spatial::reference
