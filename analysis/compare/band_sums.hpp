// SPDX-License-Identifier: GPL-3.0-or-later
// Power, cross power and error within a band, from spectra of segments.
#pragma once

#include "analysis/compare/cross_spectrum.hpp"
#include "analysis/compare/verdict.hpp"

namespace tacto::analysis {

/// Integrals over a band; each density is constant within half a bin around its bin. unit^2.
struct BandSums {
  bool paired = false;
  double aa = 0, bb = 0;
  double real_ab = 0;         ///< real part of the cross density
  double coherent_share = 0;  ///< aa times the magnitude-squared coherence

  /// Power of B - A over that of A, dB.
  double error_db() const;
  /// Least-squares gain: sum A B / sum A^2.
  double gain() const { return real_ab / aa; }
  /// Power of B - gain A over that of B, dB.
  double residual_db(double gain) const;
  double coherence() const { return coherent_share / aa; }
};

BandSums band_sums(const CrossSpectrum& mean, double low, double high);

/// The smallest error over all shifts of B: power of (shifted B - A) over that of A, in the band.
struct ShiftedError {
  double shift = 0;  ///< delay of B behind A, in the unit of 1 / frequency
  double error_db = 0;
};

/// Searches within +- `range`, to 1e-4 of it, by the phase of the spectra. The segments do not move with the
/// shift; this causes an error of about pi shift / window (-50 dB at a thousandth of a window). Precondition:
/// paired, power.
ShiftedError shifted_error(const CrossSpectrum& mean, double low, double high, double range);

/// Appends a band's powers, one per segment, as a column.
void add_band(BandPowers& powers, const SegmentSpectra& spectra, double low, double high);
/// Changes columns to rows, after all bands are added.
void by_segment(BandPowers& powers);

}  // namespace tacto::analysis
