// SPDX-License-Identifier: GPL-3.0-or-later
// Goodness of fit: deviances, and the probability of a value of chi-squared. Internal to this folder.
#pragma once

#include <cstddef>

namespace tacto::analysis {

/// What `count` of `total` answers add to the deviance from a model that gives them the probability p.
double deviance_part(double count, double total, double p);

/// The probability of a value this large or larger; 1 without degrees of freedom.
double chi_squared_p(double value, std::size_t freedom);

}  // namespace tacto::analysis
