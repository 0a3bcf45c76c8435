// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/stroke_levels.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "analysis/compare/cross_spectrum.hpp"
#include "data-schema/base/decibels.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {
namespace {

constexpr double kBandsPerDecade = 20;
constexpr double kOne_per_m = 1000;
constexpr double kEdgeRounding = 1e-9;
constexpr int kTapers = 4;
constexpr double kLevelFloorDb = 60;  // lower powers come from tapers and converters, not from the texture

// One-sided density at each bin, unit^2 m.
std::vector<double> sine_taper_density(std::span<const double> values, double pitch_m) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  spatial::RealFft fft(values.size());
  std::vector<double> tapered(values.size()), density(fft.bins());
  std::vector<std::complex<double>> spectrum(fft.bins());
  const double scale = 2 * pitch_m / kTapers * 2 / (n + 1);
  for (int k = 1; k <= kTapers; ++k) {
    for (std::size_t i = 0; i < values.size(); ++i)
      tapered[i] = (values[i] - mean) * std::sin(std::numbers::pi * k * static_cast<double>(i + 1) / (n + 1));
    fft.forward(tapered, spectrum);
    for (std::size_t b = 0; b < density.size(); ++b) density[b] += scale * std::norm(spectrum[b]);
  }
  return density;
}

double power_between(const std::vector<double>& density, double step, double low, double high) {
  double power = 0;
  const auto first = static_cast<std::size_t>(std::max(0.0, std::round(low / step)));
  for (std::size_t b = first; b < density.size() && (static_cast<double>(b) - 0.5) * step < high; ++b)
    power += density[b] * width_of_bin(static_cast<double>(b) * step, step, low, high);
  return power;
}

}  // namespace

std::vector<double> sixth_octave_edges(double low_per_m, double high_per_m) {
  const auto number = [](double per_m) { return kBandsPerDecade * std::log10(per_m / kOne_per_m); };
  std::vector<double> edges;
  const double last = std::floor(number(high_per_m) + kEdgeRounding);
  for (double x = std::ceil(number(low_per_m) - kEdgeRounding); x <= last; ++x)
    edges.push_back(kOne_per_m * std::pow(10, x / kBandsPerDecade));
  if (edges.size() < 2) edges.clear();
  return edges;
}

std::vector<double> stroke_levels_db(std::span<const double> values, double pitch_m,
                                     std::span<const double> edges_per_m) {
  const std::vector<double> density = sine_taper_density(values, pitch_m);
  const double step = 1 / (static_cast<double>(values.size()) * pitch_m);
  std::vector<double> levels;
  for (std::size_t i = 0; i + 1 < edges_per_m.size(); ++i)
    levels.push_back(power_between(density, step, edges_per_m[i], edges_per_m[i + 1]));
  const double most = *std::ranges::max_element(levels);
  if (!(most > 0)) return {};
  const double least = most * schema::power_of_db(-kLevelFloorDb);
  for (double& level : levels) level = schema::power_db(std::max(level, least));
  return levels;
}

}  // namespace tacto::analysis
