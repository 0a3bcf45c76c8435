// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace tacto::schema {

double rms_of(std::span<const double> values) {
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double student_t(double freedom, double probability) {
  using boost::math::policies::domain_error;
  using boost::math::policies::errno_on_error;
  using NoThrow = boost::math::policies::policy<domain_error<errno_on_error>>;
  return boost::math::quantile(boost::math::students_t_distribution<double, NoThrow>(std::max(freedom, 1.0)),
                               probability);
}

}  // namespace tacto::schema
