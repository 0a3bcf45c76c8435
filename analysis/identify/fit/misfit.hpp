// SPDX-License-Identifier: GPL-3.0-or-later
// Tests whether the residuals of a fit are noise. R^2 does not show it: it stays at 0.99 with a hysteresis
// that is not in the model.
#pragma once

#include <complex>
#include <span>
#include <string>

namespace tacto::analysis {

/// Limits of the reduced chi squared of Gaussian residuals: 5 in 10,000 are above the highest, and as many
/// below the lowest (Wilson and Hilferty's cube root).
double highest_chi_squared(double freedom);
double lowest_chi_squared(double freedom);

struct Misfit {
  bool found = false;
  double reduced_chi_squared = 0;  ///< 0 if the noise was not measured
  double chi_squared_limit = 0;
  /// Of neighbouring frequencies: the residual's part along the model (amplitude), and across it (phase).
  double amplitude_correlation = 0, phase_correlation = 0;
  double correlation_limit = 0;
  /// How many times the noise column is larger than the residuals show; 0 if it may be right.
  double noise_overstated = 0;
  std::string words;
};

/// Three tests, each wrong in 5 of 10,000 for white Gaussian residuals: chi squared of the whitened residuals
/// against its distribution (Wilson and Hilferty's cube root, 0.1 % off the limit from 20 degrees of freedom
/// on), if the noise is known; and the correlation of neighbouring residuals, of amplitude and of phase,
/// against 3.29 / sqrt(n). `residuals` are divided by sigma and rotated by the model's phase: real along,
/// imaginary across. Known noise is overstated if chi squared is below its lower limit, or if the median of
/// the squares is (by its order statistic), which a few outliers do not change. Precondition: more than
/// `parameters` / 2 residuals.
Misfit misfit_of(std::span<const std::complex<double>> residuals, std::size_t parameters, bool noise_known);

}  // namespace tacto::analysis
