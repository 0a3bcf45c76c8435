// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/spatial_period.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tacto::analysis {
namespace {

constexpr double kShortestPeriodM = 2e-4, kShortestPathM = 1e-3, kLeastPeriods = 4;
constexpr int kStepsAPath = 4;  // frequencies tried in 1 / path: the main lobe of the window is 4 / path wide
constexpr int kRefinements = 40;

struct WeightedSample {
  double position_m = 0, value = 0;  // the value times window and way
};

std::vector<WeightedSample> weighted(std::span<const double> x, std::span<const double> displacement_m) {
  const std::size_t n = x.size();
  std::vector<WeightedSample> samples(n);
  double sum = 0, weights = 0;
  std::vector<double> weight(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double part = (x[i] - x[0]) / (x[n - 1] - x[0]);
    const double way = std::abs(x[std::min(i + 1, n - 1)] - x[i == 0 ? 0 : i - 1]);
    weight[i] = way * std::pow(std::sin(std::numbers::pi * part), 2);
    sum += weight[i] * displacement_m[i], weights += weight[i];
  }
  const double mean = weights > 0 ? sum / weights : 0;
  for (std::size_t i = 0; i < n; ++i) samples[i] = {x[i], weight[i] * (displacement_m[i] - mean)};
  return samples;
}

double power_at(std::span<const WeightedSample> samples, double frequency_per_m) {
  std::complex<double> sum = 0;
  for (const auto& [x, value] : samples)
    sum += value * std::polar(1.0, -2 * std::numbers::pi * frequency_per_m * x);
  return std::norm(sum);
}

// The maximum between two frequencies around one peak, by thirds.
double peak_between(std::span<const WeightedSample> samples, double low, double high) {
  for (int i = 0; i < kRefinements; ++i) {
    const double third = (high - low) / 3;
    if (power_at(samples, low + third) < power_at(samples, high - third))
      low += third;
    else
      high -= third;
  }
  return (low + high) / 2;
}

}  // namespace

std::optional<double> spatial_period_m(std::span<const double> position_m,
                                       std::span<const double> displacement_m) {
  if (position_m.size() < 8) return std::nullopt;
  const double path_m = std::abs(position_m.back() - position_m.front());
  if (path_m < kShortestPathM) return std::nullopt;
  const auto samples = weighted(position_m, displacement_m);
  const double step = 1 / (kStepsAPath * path_m);
  double best = 0, largest = 0;
  for (double f = kLeastPeriods / path_m; f <= 1 / kShortestPeriodM; f += step)
    if (const double power = power_at(samples, f); power > largest) largest = power, best = f;
  if (!(largest > 0)) return std::nullopt;
  return 1 / peak_between(samples, best - step, best + step);
}

}  // namespace tacto::analysis
