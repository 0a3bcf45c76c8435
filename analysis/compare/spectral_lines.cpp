// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/spectral_lines.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "analysis/compare/local_mean.hpp"
#include "data-schema/base/decibels.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {
namespace {

using Powers = std::vector<double>;

constexpr double kTapered = 0.125;                             // of the length, at each end
constexpr std::size_t kDensity = 48, kLevel = 192, kNear = 8;  // half bins to each side
constexpr double kFewestBins = 30;
constexpr double kLineFloor = 1e-6;  // of the strongest place, as for the verdict's bands
// Bandwidths in bins, from a line's peak over the density of its bin: of the taper (1.1) and of Hann (1.5).
constexpr double kTaperBandwidth = 1.102, kHannWidth = 1.5;

// The power that 0.5 % of the pairs exceed: fitted to 30-7,680 bins (tests/analysis/compare_thresholds.py),
// within 3 %.
double chance_power(double bins) {
  const double log = std::log(bins);
  return 7.7 + 0.8 * log + 0.02 * log * log;
}

// A line of mean power P is found in 8 of 10 pairs if sqrt(P) exceeds the threshold's root by 0.84 standard
// deviations of a bin's amplitude, sqrt(1/2). The mean of 17 half bins beside the line, and frequencies
// between half bins, cost 0.8 dB (measured: compare_narrow_test).
double detectable_power(double threshold) {
  constexpr double kLost = 1.2;
  return kLost * std::pow(std::sqrt(threshold) + 0.841621 * std::numbers::sqrt2 / 2, 2);
}

Powers tapered(std::span<const double> values, std::size_t length) {
  Powers out(length, 0.0);
  const std::size_t n = values.size();
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  const auto edge = static_cast<std::size_t>(kTapered * static_cast<double>(n));
  const auto weight = [&](std::size_t from_end) {
    if (from_end >= edge) return 1.0;
    return 0.5 - 0.5 * std::cos(std::numbers::pi * (static_cast<double>(from_end) + 0.5) /
                                static_cast<double>(edge));
  };
  for (std::size_t i = 0; i < n; ++i) out[i] = weight(std::min(i, n - 1 - i)) * (values[i] - mean);
  return out;
}

// Powers of the bins within the band; the floor covers window leakage and rounding.
Powers line_powers(std::span<const double> values, spatial::RealFft& fft, std::size_t first,
                   std::size_t count) {
  const Powers frame = tapered(values, fft.length());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(frame, spectrum);
  Powers powers;
  for (std::size_t k = first; k < first + count; ++k) powers.push_back(std::norm(spectrum[k]));
  const double least = kLineFloor * std::ranges::max(local_mean(powers, kNear));
  for (double& power : powers) power += least;
  return powers;
}

Powers logarithms(const Powers& values) {
  Powers out(values.size());
  std::ranges::transform(values, out.begin(), [](double v) { return std::log(v); });
  return out;
}

// Divides each by the smooth density of both, at its own level, so that the mean is 1.
void flatten(Powers& a, Powers& b) {
  const Powers log_a = logarithms(a), log_b = logarithms(b);
  const Powers near_a = local_mean(log_a, kDensity), near_b = local_mean(log_b, kDensity);
  const Powers far_a = local_mean(log_a, kLevel), far_b = local_mean(log_b, kLevel);
  for (std::size_t k = 0; k < a.size(); ++k) {
    // The mean logarithm of an exponential variable is -gamma.
    const double density = 0.5 * (near_a[k] + near_b[k]) + std::numbers::egamma;
    const double half_level = 0.5 * (far_b[k] - far_a[k]);
    a[k] = std::exp(log_a[k] - density + half_level);
    b[k] = std::exp(log_b[k] - density - half_level);
  }
}

struct Peak {
  std::size_t at = 0;
  double power = 0;
};
Peak highest_over(const Powers& powers, const Powers& others) {
  const Powers beside = local_mean(others, kNear);
  Peak peak;
  for (std::size_t k = 0; k < powers.size(); ++k)
    if (const double power = powers[k] / std::max(1.0, beside[k]); power > peak.power) peak = {k, power};
  return peak;
}

}  // namespace

std::optional<SpectralLine> strongest_line(std::span<const double> a, std::span<const double> b, double pitch,
                                           double low, double high, double window) {
  const std::size_t n = std::min(a.size(), b.size());
  const double length = static_cast<double>(n) * pitch, bins = (high - low) * length;
  if (bins < kFewestBins) return std::nullopt;
  spatial::RealFft fft(spatial::fast_length(2 * n));
  const double step = 1 / (static_cast<double>(fft.length()) * pitch);
  const auto first = static_cast<std::size_t>(std::ceil(low / step));
  const auto last = std::min(fft.bins() - 1, static_cast<std::size_t>(high / step));
  Powers of_a = line_powers(a.first(n), fft, first, last - first + 1);
  Powers of_b = line_powers(b.first(n), fft, first, last - first + 1);
  flatten(of_a, of_b);
  const Peak in_a = highest_over(of_a, of_b), in_b = highest_over(of_b, of_a);
  const Peak& peak = in_b.power > in_a.power ? in_b : in_a;
  const auto level_db = [&](double power) {  // `power` in units of a bin's power
    return schema::power_db(1 + power * kTaperBandwidth * window / (kHannWidth * static_cast<double>(n)));
  };
  const double threshold = chance_power(bins);
  return SpectralLine{static_cast<double>(first + peak.at) * step,
                      in_b.power > in_a.power,
                      level_db(std::max(0.0, peak.power - 1)),
                      peak.power,
                      threshold,
                      level_db(detectable_power(threshold))};
}

}  // namespace tacto::analysis
