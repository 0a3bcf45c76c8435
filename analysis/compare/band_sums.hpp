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

BandSums band_sums(const CrossSpectrum& mean, const SegmentSpectra& spectra, double low, double high);

/// Appends a band's powers, segment by segment: a column.
void add_band(BandPowers& powers, const SegmentSpectra& spectra, double low, double high);
/// Once all bands are added: from columns to rows.
void by_segment(BandPowers& powers);

}  // namespace tacto::analysis
