// SPDX-License-Identifier: GPL-3.0-or-later
// Whether residuals are of one size all over the band.
#pragma once

#include <complex>
#include <span>
#include <string>

namespace tacto::analysis {

struct NoiseEvenness {
  bool uneven = false;
  double low_hz = 0, high_hz = 0;  ///< the part of the band that is most unlike the rest
  double times = 1;                ///< its residuals' RMS over that of the rest
};

/// Bartlett's test (1937) of a part of the band against the rest, about a mean of 0, for every part of an
/// eighth, a sixth, a quarter, a third and a half of the frequencies. The largest is held to 22: of white,
/// Gaussian residuals of 16 to 1,000 frequencies 5 in 10,000 pass 18.4 to 22.6 (40,000 draws each). Of fewer
/// than 16 nothing is said, nor where a part leaves nothing. Precondition: as many frequencies.
NoiseEvenness evenness_of(std::span<const std::complex<double>> residuals,
                          std::span<const double> frequency_hz);

/// "... the residuals are 3.2 times as large from 290 to 650 Hz as elsewhere ...", and what to do.
std::string evenness_words(const NoiseEvenness& evenness);

}  // namespace tacto::analysis
