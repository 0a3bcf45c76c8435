// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of an operator that was fitted to loops: by noise, and by missing play operators.
#pragma once

#include <span>
#include <vector>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// Loops and the fit by play operators, from the first sample with a known state on.
struct FittedOperator {
  std::span<const double> drive_v;  ///< the whole drive
  std::size_t first = 0;            ///< first sample of the fit
  schema::Hysteresis found;         ///< as fitted, not scaled
  std::span<const double> left;     ///< residual of the displacement, from `first` on
};

struct OperatorErrors {
  double noise = 0;   ///< RMS of the part of `left` that neighbouring samples do not share
  double misfit = 0;  ///< RMS of the shared part; 0 if it is not distinguishable from the noise
  /// Changes of the operator along independent directions, one standard error each, in its unit: by the
  /// noise, and by the misfit. Their thresholds are the operator's and those in the middle.
  std::vector<schema::Hysteresis> by_noise, by_misfit;
};

/// The noise is half the mean square of neighbours' differences (von Neumann 1941). The residual beyond it is
/// a misfit, if white noise would cause it in at most 5 of 10,000 cases. Noise: the covariance of the
/// weights. Misfit: play operators that the operator lacks, one in the middle of each two of its thresholds,
/// with weights like its own, scaled to explain the misfit. Each changes the operator independently, minus
/// the part that the fit would absorb.
OperatorErrors operator_errors(const FittedOperator& fitted);

}  // namespace tacto::analysis
