// SPDX-License-Identifier: GPL-3.0-or-later
// Whether what a fit leaves is noise. R^2 does not say: it stays at 0.99 under a hysteresis that nobody
// modelled.
#pragma once

#include <complex>
#include <span>
#include <string>

namespace tacto::analysis {

struct Misfit {
  bool found = false;
  double reduced_chi_squared = 0;  ///< 0 where nobody measured the noise
  double chi_squared_limit = 0;
  /// Of neighbouring frequencies: the residual's part along the model (amplitude) and across it (phase).
  double amplitude_correlation = 0, phase_correlation = 0;
  double correlation_limit = 0;
  std::string words;
};

/// Three tests, each wrong in 5 of 10,000 where the residuals are white and Gaussian: chi squared of the
/// whitened residuals against its own distribution (Wilson and Hilferty's cube root, 0.1 % off the limit from
/// 20 degrees of freedom on), where the noise is known; and the correlation of neighbouring residuals, of
/// their amplitude and of their phase, against 3.29 / sqrt(n). `residuals` are over sigma and turned by the
/// model's phase: real along, imaginary across. Precondition: more than `parameters` / 2 of them.
Misfit misfit_of(std::span<const std::complex<double>> residuals, std::size_t parameters, bool noise_known);

}  // namespace tacto::analysis
