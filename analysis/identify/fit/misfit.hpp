// SPDX-License-Identifier: GPL-3.0-or-later
// Whether what a fit leaves is noise. R^2 does not say: it stays at 0.99 under a hysteresis that nobody
// modelled.
#pragma once

#include <complex>
#include <span>
#include <string>

namespace tacto::analysis {

/// Reduced chi squared of Gaussian residuals that is passed in 5 of 10,000, and the one that is not reached
/// in as many (Wilson and Hilferty's cube root).
double highest_chi_squared(double freedom);
double lowest_chi_squared(double freedom);

struct Misfit {
  bool found = false;
  double reduced_chi_squared = 0;  ///< 0 where nobody measured the noise
  double chi_squared_limit = 0;
  /// Of neighbouring frequencies: the residual's part along the model (amplitude) and across it (phase).
  double amplitude_correlation = 0, phase_correlation = 0;
  double correlation_limit = 0;
  /// The noise that was measured is larger than what is left: the column says too much. 0 where it may be
  /// right, else how many times.
  double noise_overstated = 0;
  std::string words;
};

/// Three tests, each wrong in 5 of 10,000 where the residuals are white and Gaussian: chi squared of the
/// whitened residuals against its own distribution (Wilson and Hilferty's cube root, 0.1 % off the limit from
/// 20 degrees of freedom on), where the noise is known; and the correlation of neighbouring residuals, of
/// their amplitude and of their phase, against 3.29 / sqrt(n). `residuals` are over sigma and turned by the
/// model's phase: real along, imaginary across. Noise that is known is overstated where chi squared is below
/// its own limit at the other end, or the median of the squares is (by its order statistic): that one is not
/// moved by a few values that are off. Precondition: more than `parameters` / 2 of them.
Misfit misfit_of(std::span<const std::complex<double>> residuals, std::size_t parameters, bool noise_known);

}  // namespace tacto::analysis
