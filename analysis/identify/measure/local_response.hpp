// SPDX-License-Identifier: GPL-3.0-or-later
// A frequency response near one bin of a whole record's spectrum, whatever drove it.
#pragma once

#include <complex>
#include <cstddef>
#include <span>

namespace tacto::analysis {

struct LocalResponse {
  std::complex<double> response;
  double offset = 0;  ///< bins from the middle to where the response is known best, and given
  /// Power of what the model leaves, a bin, and the degrees of freedom (complex) that it is told by.
  double noise_power = 0, freedom = 0;
  /// Of the response, for noise of power 1 a bin: the variance of its real and of its imaginary part.
  double variance_for_one = 0;
};

/// Local polynomial method (Pintelon, Schoukens, Vandersteen and Barbe 2010): within these bins of the
/// spectra of a whole record, Y = G U + T + noise, with the response G and (where `transient`) what the
/// record's two ends make, T, as polynomials of second degree in the frequency. Least squares by singular
/// values. It is given where its variance is least, within half the bins of their middle: a line between two
/// bins tells the response at itself only. Error: of third degree in bins over the response's own width, in
/// bins. Preconditions: as many input as output bins, odd, kLeastLocalBins at least.
LocalResponse local_response(std::span<const std::complex<double>> input,
                             std::span<const std::complex<double>> output, bool transient);

inline constexpr std::size_t kLeastLocalBins = 15;  // six unknowns, and nine bins to tell the noise by

}  // namespace tacto::analysis
