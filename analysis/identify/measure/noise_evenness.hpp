// SPDX-License-Identifier: GPL-3.0-or-later
// Tests whether residuals have the same size in the whole band.
#pragma once

#include <complex>
#include <span>
#include <string>

namespace tacto::analysis {

struct NoiseEvenness {
  bool uneven = false;
  double low_hz = 0, high_hz = 0;  ///< the part of the band that differs most from the rest
  double times = 1;                ///< RMS of its residuals over that of the rest
};

/// Bartlett's test (1937) of a part of the band against the rest, with a mean of 0, for every part of an
/// eighth, a sixth, a quarter, a third and a half of the frequencies. The threshold for the largest statistic
/// is 22: for white Gaussian residuals of 16 to 1,000 frequencies, 5 in 10,000 exceed 18.4 to 22.6 (40,000
/// draws each). Fewer than 16 frequencies, and parts without residuals, are not tested. Precondition: equal
/// numbers of residuals and frequencies.
NoiseEvenness evenness_of(std::span<const std::complex<double>> residuals,
                          std::span<const double> frequency_hz);

/// "the residuals are 3.2 times as large from 290 to 650 Hz as elsewhere".
std::string uneven_residuals_words(const NoiseEvenness& evenness);

/// "... the residuals are 3.2 times as large from 290 to 650 Hz as elsewhere ...", and what to do.
std::string evenness_words(const NoiseEvenness& evenness);

}  // namespace tacto::analysis
