// SPDX-License-Identifier: GPL-3.0-or-later
// Proportion correct and d' in a choice of m alternatives, one of which has the signal; d' of same or
// different.
#pragma once

#include <cstddef>
#include <optional>

#include "analysis/psychometrics/psychometric_fit.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// The integral of phi(x - d') Phi(x)^(m - 1) over x (Green and Swets 1966), within 1e-9 for |d'| up to 10.
/// Precondition: m is 2 or more. Pure.
double proportion_correct(double d_prime, std::size_t alternatives);

/// Its inverse. Errors: unsuitable, for a proportion of 0 or 1 (a bound), or one whose |d'| is above 10.
schema::Result<double> d_prime_of(double proportion, std::size_t alternatives);

/// How often two things were called the same: `own` trials in which they belong together, `other` in which
/// they do not.
struct SameAnswers {
  double same_of_own = 0, own = 0;
  double same_of_other = 0, other = 0;
};

/// z(H) - z(F) of a yes-no decision, with the shares (n + 1/2) / (N + 1) (Hautus 1995, Behav. Res. Methods
/// 27, 46) and the 95 % interval by the variance of Gourevitch and Galanter 1967 (Psychometrika 32, 25).
/// None: no trials of one kind. Pure.
std::optional<Estimate> d_prime_of_same(const SameAnswers& answers);

}  // namespace tacto::analysis
