// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/hermite.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tacto::spatial {
namespace {

int sign(double value) {
  return (value > 0) - (value < 0);
}

// Weighted harmonic mean of the secants on both sides (Fritsch and Butland 1984), 0 at an extremum.
double inner_slope(double h0, double h1, double secant0, double secant1) {
  if (secant0 == 0 || sign(secant0) != sign(secant1)) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / secant0 + w1 / secant1);
}

// The one-sided three-point slope, limited so that the end segment stays monotone.
double end_slope(double h0, double h1, double secant0, double secant1) {
  const double slope = ((2 * h0 + h1) * secant0 - h0 * secant1) / (h0 + h1);
  if (sign(slope) != sign(secant0)) return 0;
  if (sign(secant0) != sign(secant1) && std::abs(slope) > 3 * std::abs(secant0)) return 3 * secant0;
  return slope;
}

}  // namespace

std::vector<double> hermite_slopes(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size() && x.size() >= 2);
  const std::size_t n = x.size();
  const auto width = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / width(i); };
  std::vector<double> slopes(n, secant(0));
  if (n == 2) return slopes;
  for (std::size_t i = 1; i + 1 < n; ++i)
    slopes[i] = inner_slope(width(i - 1), width(i), secant(i - 1), secant(i));
  slopes.front() = end_slope(width(0), width(1), secant(0), secant(1));
  slopes.back() = end_slope(width(n - 2), width(n - 3), secant(n - 2), secant(n - 3));
  return slopes;
}

std::vector<double> hermite_slopes_uniform(double step, std::span<const double> y) {
  assert(y.size() >= 2);
  const std::size_t n = y.size();
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / step; };
  std::vector<double> slopes(n, secant(0));
  if (n == 2) return slopes;
  for (std::size_t i = 1; i + 1 < n; ++i) slopes[i] = inner_slope(step, step, secant(i - 1), secant(i));
  slopes.front() = end_slope(step, step, secant(0), secant(1));
  slopes.back() = end_slope(step, step, secant(n - 2), secant(n - 3));
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
