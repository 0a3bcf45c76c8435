// SPDX-License-Identifier: GPL-3.0-or-later
// Goodness of fit. Internal to this folder.
#pragma once

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstddef>

namespace tacto::analysis {

/// What `count` of `total` answers add to the deviance from a model that gives them the probability p.
inline double deviance_part(double count, double total, double p) {
  return count > 0 ? 2 * count * std::log(count / total / p) : 0;
}

/// The probability of a value this large or larger; 1 without degrees of freedom.
inline double chi_squared_p(double value, std::size_t freedom) {
  if (freedom == 0) return 1;
  const boost::math::chi_squared distribution(static_cast<double>(freedom));
  return boost::math::cdf(boost::math::complement(distribution, std::max(0.0, value)));  // rounding: below 0
}

}  // namespace tacto::analysis
