// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/hermite_inverse.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tacto::spatial {
namespace {

// On smooth strokes Newton's method needs at most 6 steps. At a triple root the error falls by a factor of
// 2/3 per step, which needs 60.
constexpr int kMostSteps = 100;
constexpr double kSmallestStep = 1e-10;

}  // namespace

double solve_segment(const HermiteSegment& segment, double value) {
  const double target = value - segment.y0, rise = segment.y1 - segment.y0;
  if (target <= 0) return 0;
  if (target >= rise) return 1;
  double low = 0, high = 1, u = target / rise;
  for (int i = 0; i < kMostSteps; ++i) {
    const double miss = segment.rise(u) - target;
    if (miss == 0) return u;
    (miss > 0 ? high : low) = u;
    double next = u - miss / segment.derivative(u);
    if (!(next > low && next < high)) next = (low + high) / 2;
    const double step = std::abs(next - u);
    u = next;
    if (step < kSmallestStep) break;
  }
  return u;
}

HermiteInverse::HermiteInverse(std::span<const double> t, std::span<const double> x)
    : t_(t), x_(x), curve_(t, x) {}

std::size_t HermiteInverse::segment_of(double x) const {
  return static_cast<std::size_t>(std::upper_bound(x_.begin() + 1, x_.end() - 1, x) - x_.begin()) - 1;
}

double HermiteInverse::operator()(double x) const {
  const std::size_t i = segment_of(x);
  return t_[i] + solve_segment(curve_.segment(i), x) * (t_[i + 1] - t_[i]);
}

void HermiteInverse::evaluate_sorted(std::span<const double> at, std::span<double> t) const {
  assert(at.size() == t.size());
  if (at.empty()) return;
  const std::size_t last = x_.size() - 2;
  std::size_t i = segment_of(at.front());
  HermiteSegment segment = curve_.segment(i);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const std::size_t before = i;
    while (i < last && at[k] >= x_[i + 1]) ++i;
    if (i != before) segment = curve_.segment(i);
    t[k] = t_[i] + solve_segment(segment, at[k]) * (t_[i + 1] - t_[i]);
  }
}

}  // namespace tacto::spatial
