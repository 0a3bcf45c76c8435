// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>

namespace tacto::schema {

double student_t(double freedom, double probability) {
  using boost::math::policies::domain_error;
  using boost::math::policies::errno_on_error;
  using NoThrow = boost::math::policies::policy<domain_error<errno_on_error>>;
  return boost::math::quantile(boost::math::students_t_distribution<double, NoThrow>(std::max(freedom, 1.0)),
                               probability);
}

}  // namespace tacto::schema
