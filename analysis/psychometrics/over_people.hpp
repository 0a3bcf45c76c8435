// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of several people as one: Student's t on their logarithms.
#pragma once

#include <span>

#include "analysis/psychometrics/psychometric_fit.hpp"

namespace tacto::analysis {

/// Quantile 97.5 % of Student's t: the ends of a 95 % interval in standard errors. Pure.
double student_reach(double freedom);

/// Geometric mean with its 95 % interval: one figure per person, each above 0. With fewer than two people the
/// interval is infinite. Pure.
Estimate geometric_mean(std::span<const double> figures);

struct PairedTest {
  double t = 0, p = 1;
  double freedom = 0;
};

/// Paired t test of log a against log b, two-sided. Precondition: the same people in the same order, at least
/// two. Pure.
PairedTest paired_log_test(std::span<const double> a, std::span<const double> b);

}  // namespace tacto::analysis
