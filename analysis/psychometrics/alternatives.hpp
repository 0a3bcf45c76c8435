// SPDX-License-Identifier: GPL-3.0-or-later
// Proportion correct and d' in a choice of m alternatives, one of which has the signal.
#pragma once

#include <cstddef>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// The integral of phi(x - d') Phi(x)^(m - 1) over x (Green and Swets 1966), within 1e-9 for |d'| up to 10.
/// Precondition: m is 2 or more. Pure.
double proportion_correct(double d_prime, std::size_t alternatives);

/// Its inverse. Errors: unsuitable, for a proportion of 0 or 1 (a bound), or one whose |d'| is above 10.
schema::Result<double> d_prime_of(double proportion, std::size_t alternatives);

}  // namespace tacto::analysis
