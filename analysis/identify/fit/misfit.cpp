// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/misfit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

constexpr double kQuantile = 3.2905;  // of the normal distribution; 5 in 10,000 exceed it

double chi_squared_at(double quantile, double freedom) {
  const double spread = 2 / (9 * freedom);
  return std::pow(std::max(0.0, 1 - spread + quantile * std::sqrt(spread)), 3);
}

// Median of |r|^2, which is exponentially distributed, over its expected value, 1 / ln 2 of ...
double median_square(std::span<const std::complex<double>> residuals) {
  std::vector<double> squares;
  for (const auto& r : residuals) squares.push_back(std::norm(r));
  return schema::upper_median(std::span(squares)) / (2 * std::numbers::ln2);
}

// ... and its lower limit. The median's place in the distribution follows a beta distribution of standard
// deviation 1 / (2 sqrt(n + 2)); ten values or fewer have no limit.
double lowest_median_square(double values) {
  const double place = 0.5 - kQuantile / (2 * std::sqrt(values + 2));
  return place > 0 ? -std::log1p(-place) / std::numbers::ln2 : 0;
}

double times_overstated(double chi_squared, double freedom, std::span<const std::complex<double>> residuals) {
  const double n = static_cast<double>(residuals.size()), median = median_square(residuals) * 2 * n / freedom;
  if (chi_squared >= lowest_chi_squared(freedom) && median >= lowest_median_square(n)) return 0;
  return 1 / std::sqrt(std::min(chi_squared, median));
}

double neighbours(std::span<const std::complex<double>> residuals, double (*part)(std::complex<double>)) {
  double across = 0, own = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (i > 0) across += part(residuals[i - 1]) * part(residuals[i]);
    own += part(residuals[i]) * part(residuals[i]);
  }
  return own > 0 ? across / own : 0;
}

std::string words_of(const Misfit& m) {
  std::string words;
  if (m.reduced_chi_squared > m.chi_squared_limit)
    words = fmt::format("the residuals are {:.3g} times the noise (at most {:.3g})",
                        std::sqrt(m.reduced_chi_squared), std::sqrt(m.chi_squared_limit));
  const auto add = [&](const char* what, double correlation) {
    if (correlation > m.correlation_limit)
      words += fmt::format("{}neighbouring residuals of the {} are correlated ({:.2f}, at most {:.2f})",
                           words.empty() ? "" : "; ", what, correlation, m.correlation_limit);
  };
  add("phase", m.phase_correlation);
  add("amplitude", m.amplitude_correlation);
  return words;
}

}  // namespace

double highest_chi_squared(double freedom) {
  return chi_squared_at(kQuantile, freedom);
}

double lowest_chi_squared(double freedom) {
  return chi_squared_at(-kQuantile, freedom);
}

Misfit misfit_of(std::span<const std::complex<double>> residuals, std::size_t parameters, bool noise_known) {
  Misfit m;
  const double freedom = 2 * static_cast<double>(residuals.size()) - static_cast<double>(parameters);
  double squares = 0;
  for (const auto& r : residuals) squares += std::norm(r);
  m.chi_squared_limit = highest_chi_squared(freedom);
  if (noise_known) {
    m.reduced_chi_squared = squares / freedom;
    m.noise_overstated = times_overstated(m.reduced_chi_squared, freedom, residuals);
  }
  m.correlation_limit = kQuantile / std::sqrt(static_cast<double>(residuals.size()));
  m.amplitude_correlation = neighbours(residuals, [](std::complex<double> r) { return r.real(); });
  m.phase_correlation = neighbours(residuals, [](std::complex<double> r) { return r.imag(); });
  m.words = words_of(m);
  m.found = !m.words.empty();
  return m;
}

}  // namespace tacto::analysis
