// SPDX-License-Identifier: GPL-3.0-or-later
// How an operator that was found from loops may err: by noise, and where it has no play.
#pragma once

#include <span>
#include <vector>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// Loops and what a fit by plays made of them, from the first sample whose past is known on.
struct FittedOperator {
  std::span<const double> drive_v;  ///< all of it
  std::size_t first = 0;            ///< sample that is fitted first
  schema::Hysteresis found;         ///< as fitted, not scaled
  std::span<const double> left;     ///< of the answer, from `first` on
};

struct OperatorErrors {
  double noise = 0;   ///< RMS of what neighbouring samples of `left` do not share
  double misfit = 0;  ///< RMS of what they do; 0 where it can't be told from the noise
  /// Changes of the operator along independent directions, one standard error each, in its own unit: by the
  /// noise, and by the misfit. Their thresholds are the operator's and those between.
  std::vector<schema::Hysteresis> by_noise, by_misfit;
};

/// The noise is half the mean square of neighbours' differences (von Neumann 1941); what is left beyond it,
/// where white noise would do that in 5 of 10,000 cases at most, is a misfit. Noise: the weights' own
/// covariance. A misfit: plays that the operator lacks, one in the middle of each two of its thresholds, with
/// weights like its own, to the size that explains the misfit; each changes the operator by itself, less what
/// the fit would have made of it.
OperatorErrors operator_errors(const FittedOperator& fitted);

}  // namespace tacto::analysis
