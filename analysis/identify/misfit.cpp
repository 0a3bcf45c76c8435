// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/misfit.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tacto::analysis {
namespace {

constexpr double kQuantile = 3.2905;  // of the normal distribution: 5 in 10,000 beyond

double chi_squared_limit(double freedom) {
  const double spread = 2 / (9 * freedom);
  return std::pow(1 - spread + kQuantile * std::sqrt(spread), 3);
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
      words += fmt::format("{}residual {} runs in waves over frequency (correlation {:.2f}, at most {:.2f})",
                           words.empty() ? "" : "; ", what, correlation, m.correlation_limit);
  };
  add("phase", m.phase_correlation);
  add("amplitude", m.amplitude_correlation);
  return words;
}

}  // namespace

Misfit misfit_of(std::span<const std::complex<double>> residuals, std::size_t parameters, bool noise_known) {
  Misfit m;
  const double freedom = 2 * static_cast<double>(residuals.size()) - static_cast<double>(parameters);
  double squares = 0;
  for (const auto& r : residuals) squares += std::norm(r);
  m.chi_squared_limit = chi_squared_limit(freedom);
  if (noise_known) m.reduced_chi_squared = squares / freedom;
  m.correlation_limit = kQuantile / std::sqrt(static_cast<double>(residuals.size()));
  m.amplitude_correlation = neighbours(residuals, [](std::complex<double> r) { return r.real(); });
  m.phase_correlation = neighbours(residuals, [](std::complex<double> r) { return r.imag(); });
  m.words = words_of(m);
  m.found = !m.words.empty();
  return m;
}

}  // namespace tacto::analysis
