// SPDX-License-Identifier: GPL-3.0-or-later
// The frequency response near one bin of a whole record's spectrum, for any excitation.
#pragma once

#include <complex>
#include <cstddef>
#include <span>

namespace tacto::analysis {

struct LocalResponse {
  std::complex<double> response;
  double offset = 0;  ///< of the result from the middle, bins; there the variance is least
  /// Power of the residuals per bin, and its degrees of freedom (complex).
  double noise_power = 0, freedom = 0;
  /// Variance of the real part, and of the imaginary part, of the response for noise of power 1 per bin.
  double variance_for_one = 0;
};

/// Local polynomial method (Pintelon, Schoukens, Vandersteen and Barbe 2010): within these bins of the
/// spectra of a whole record, Y = G U + T + noise. The response G and (if `transient`) the effect of the
/// record's two ends, T, are polynomials of second degree in the frequency. Least squares by singular values.
/// The result is given at the frequency of least variance, within half the bins of their middle: a line
/// between two bins determines the response only at its own frequency. Error: of third degree in bins over
/// the width of the response, in bins. Preconditions: equal numbers of input and output bins, odd, at least
/// kLeastLocalBins.
LocalResponse local_response(std::span<const std::complex<double>> input,
                             std::span<const std::complex<double>> output, bool transient);

inline constexpr std::size_t kLeastLocalBins = 15;  // six unknowns, and nine bins for the noise

}  // namespace tacto::analysis
