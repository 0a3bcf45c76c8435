// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/hermite.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "spatial/dsp/fourier/simd_clones.hpp"

namespace tacto::spatial {
namespace {

int sign(double value) {
  return (value > 0) - (value < 0);
}

bool same_way(double secant0, double secant1) {
  return ((secant0 > 0) & (secant1 > 0)) | ((secant0 < 0) & (secant1 < 0));
}

// Weighted harmonic means of the secants on both sides (Fritsch and Butland 1984), 0 at an extremum:
// (w0 + w1) / (w0 / s0 + w1 / s1), written with fewer divisions and without overflow of small secants.
TACTO_SIMD_CLONES
void inner_slopes(const double* x, const double* y, double* slopes, std::size_t last) {
  for (std::size_t i = 1; i < last; ++i) {
    const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i], d0 = y[i] - y[i - 1], d1 = y[i + 1] - y[i];
    const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
    const double mean = (w0 + w1) * d1 / (w0 * h0 * (d1 / d0) + w1 * h1);
    slopes[i] = same_way(d0, d1) ? mean : 0;
  }
}

TACTO_SIMD_CLONES
void inner_slopes_uniform(double step, const double* y, double* slopes, std::size_t last) {
  const double per_step = 2 / step;
  for (std::size_t i = 1; i < last; ++i) {
    const double d0 = y[i] - y[i - 1], d1 = y[i + 1] - y[i];
    const double mean = per_step * d0 * (d1 / (d0 + d1));
    slopes[i] = same_way(d0, d1) ? mean : 0;
  }
}

// The one-sided three-point slope, limited so that the end segment stays monotone.
double end_slope(double h0, double h1, double secant0, double secant1) {
  const double slope = ((2 * h0 + h1) * secant0 - h0 * secant1) / (h0 + h1);
  if (sign(slope) != sign(secant0)) return 0;
  if (sign(secant0) != sign(secant1) && std::abs(slope) > 3 * std::abs(secant0)) return 3 * secant0;
  return slope;
}

}  // namespace

void hermite_slopes(std::span<const double> x, std::span<const double> y, std::span<double> slopes) {
  assert(x.size() == y.size() && x.size() >= 2 && slopes.size() == y.size());
  const std::size_t n = x.size();
  const auto width = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / width(i); };
  slopes.front() = slopes.back() = secant(0);
  if (n == 2) return;
  inner_slopes(x.data(), y.data(), slopes.data(), n - 1);
  slopes.front() = end_slope(width(0), width(1), secant(0), secant(1));
  slopes.back() = end_slope(width(n - 2), width(n - 3), secant(n - 2), secant(n - 3));
}

void hermite_slopes_uniform(double step, std::span<const double> y, std::span<double> slopes) {
  assert(y.size() >= 2 && slopes.size() == y.size());
  const std::size_t n = y.size();
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / step; };
  slopes.front() = slopes.back() = secant(0);
  if (n == 2) return;
  inner_slopes_uniform(step, y.data(), slopes.data(), n - 1);
  slopes.front() = end_slope(step, step, secant(0), secant(1));
  slopes.back() = end_slope(step, step, secant(n - 2), secant(n - 3));
}

std::vector<double> hermite_slopes(std::span<const double> x, std::span<const double> y) {
  std::vector<double> slopes(y.size());
  hermite_slopes(x, y, slopes);
  return slopes;
}

std::vector<double> hermite_slopes_uniform(double step, std::span<const double> y) {
  std::vector<double> slopes(y.size());
  hermite_slopes_uniform(step, y, slopes);
  return slopes;
}

HermiteCurve::HermiteCurve(std::span<const double> x, std::span<const double> y)
    : x_(x), y_(y), slopes_(hermite_slopes(x, y)) {}

HermiteSegment HermiteCurve::segment(std::size_t i) const {
  assert(i + 1 < x_.size());
  const double h = x_[i + 1] - x_[i];
  return {y_[i], y_[i + 1], slopes_[i] * h, slopes_[i + 1] * h};
}

double HermiteCurve::operator()(double x) const {
  const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - x_.begin()) - 1;
  return segment(i).value((x - x_[i]) / (x_[i + 1] - x_[i]));
}

void HermiteCurve::evaluate_sorted(std::span<const double> at, std::span<double> out) const {
  assert(at.size() == out.size());
  const std::size_t last = x_.size() - 2;
  std::size_t i = 0;
  HermiteSegment piece = segment(0);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const std::size_t before = i;
    while (i < last && at[k] >= x_[i + 1]) ++i;
    if (i != before) piece = segment(i);
    out[k] = piece.value((at[k] - x_[i]) / (x_[i + 1] - x_[i]));
  }
}

UniformHermiteCurve::UniformHermiteCurve(double start, double step, std::span<const double> y)
    : start_(start), step_(step), y_(y), slopes_(hermite_slopes_uniform(step, y)) {}

HermiteSegment UniformHermiteCurve::segment(std::size_t i) const {
  assert(i + 1 < y_.size());
  return {y_[i], y_[i + 1], slopes_[i] * step_, slopes_[i + 1] * step_};
}

double UniformHermiteCurve::operator()(double x) const {
  const double place = (x - start_) / step_;
  const double last = static_cast<double>(y_.size() - 2);
  const double i = std::clamp(std::floor(place), 0.0, last);
  return segment(static_cast<std::size_t>(i)).value(place - i);
}

}  // namespace tacto::spatial
