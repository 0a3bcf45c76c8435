// SPDX-License-Identifier: GPL-3.0-or-later
// Power, cross power and error within a band, from spectra by segment.
#pragma once

#include "analysis/compare/cross_spectrum.hpp"
#include "analysis/compare/verdict.hpp"

namespace tacto::analysis {

/// Integrals over a band, each density being constant within half a bin of its bin. unit^2.
struct BandSums {
  bool paired = false;
  double aa = 0, bb = 0;
  double real_ab = 0;         ///< of the cross density's real part
  double coherent_share = 0;  ///< of aa times the magnitude-squared coherence

  /// Of B - A over A, dB.
  double error_db() const;
  /// sum A B / sum A^2: least squares.
  double gain() const { return real_ab / aa; }
  /// Of B - gain A over B, dB.
  double residual_db(double gain) const;
  double coherence() const { return coherent_share / aa; }
};

BandSums band_sums(const CrossSpectrum& mean, double low, double high);

/// Power of B, shifted back by the shift that makes it smallest, less A; over A's, in the band.
struct ShiftedError {
  double shift = 0;  ///< of B behind A, in the unit of 1 / frequency
  double error_db = 0;
};

/// Within +- `range`, to a ten-thousandth of it, by the spectra's phase. Segments are not moved with the
/// shift: that leaves an error of some pi shift / window (-50 dB at a thousandth of a window). Precondition:
/// paired, power.
ShiftedError shifted_error(const CrossSpectrum& mean, double low, double high, double range);

/// Appends a band's powers, segment by segment: a column.
void add_band(BandPowers& powers, const SegmentSpectra& spectra, double low, double high);
/// Once all bands are added: from columns to rows.
void by_segment(BandPowers& powers);

}  // namespace tacto::analysis
