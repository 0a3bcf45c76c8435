// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/noise_evenness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tacto::analysis {
namespace {

constexpr std::size_t kFewest = 16, kShortest = 4;  // frequencies
constexpr std::size_t kFractions[] = {8, 6, 4, 3, 2};
constexpr double kMostUneven = 22;

// Sums for a part of the band; a frequency has two values.
struct PartSize {
  double values = 0, squares = 0;
  double variance() const { return squares / values; }
  double logarithms() const { return values * std::log(variance()); }
};

double bartlett(const PartSize& part, const PartSize& rest) {
  const PartSize whole{part.values + rest.values, part.squares + rest.squares};
  const double apart = whole.logarithms() - part.logarithms() - rest.logarithms();
  return apart / (1 + (1 / part.values + 1 / rest.values - 1 / whole.values) / 3);
}

// Cumulative sums of the squares: before each frequency, and of all.
std::vector<double> sums_of_squares(std::span<const std::complex<double>> residuals) {
  std::vector<double> sums = {0};
  for (const auto& r : residuals) sums.push_back(sums.back() + std::norm(r));
  return sums;
}

struct Comparison {
  double statistic = 0, times = 1;
};

Comparison part_and_rest(std::span<const double> sums, std::size_t begin, std::size_t length) {
  const double values = 2 * static_cast<double>(length), all = 2 * static_cast<double>(sums.size() - 1),
               squares = sums[begin + length] - sums[begin];
  const PartSize part{values, squares}, rest{all - values, sums.back() - squares};
  if (!(part.squares > 0 && rest.squares > 0)) return {};
  return {bartlett(part, rest), std::sqrt(part.variance() / rest.variance())};
}

}  // namespace

NoiseEvenness evenness_of(std::span<const std::complex<double>> residuals,
                          std::span<const double> frequency_hz) {
  const std::size_t n = residuals.size();
  if (n < kFewest) return {};
  const std::vector<double> sums = sums_of_squares(residuals);
  NoiseEvenness found;
  double most = kMostUneven;
  for (const std::size_t fraction : kFractions) {
    const std::size_t length = std::max(n / fraction, kShortest);
    for (std::size_t begin = 0; begin + length <= n; ++begin) {
      const Comparison compared = part_and_rest(sums, begin, length);
      if (compared.statistic <= most) continue;
      most = compared.statistic;
      found = {true, frequency_hz[begin], frequency_hz[begin + length - 1], compared.times};
    }
  }
  return found;
}

std::string uneven_residuals_words(const NoiseEvenness& evenness) {
  return fmt::format("the residuals are {:.2g} times as large from {:.4g} to {:.4g} Hz as elsewhere",
                     evenness.times, evenness.low_hz, evenness.high_hz);
}

std::string evenness_words(const NoiseEvenness& evenness) {
  return fmt::format(
      "the noise is {:.2g} times as large from {:.4g} to {:.4g} Hz as elsewhere; intervals use the local "
      "residuals, a column of noise improves them",
      evenness.times, evenness.low_hz, evenness.high_hz);
}

}  // namespace tacto::analysis
