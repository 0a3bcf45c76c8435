// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/student.hpp"

#include <cmath>

namespace tacto::analysis {

double student_95(double freedom) {
  const double z = kNormal95, n = freedom;
  return z + (std::pow(z, 3) + z) / (4 * n) +
         (5 * std::pow(z, 5) + 16 * std::pow(z, 3) + 3 * z) / (96 * n * n) +
         (3 * std::pow(z, 7) + 19 * std::pow(z, 5) + 17 * std::pow(z, 3) - 15 * z) / (384 * n * n * n);
}

}  // namespace tacto::analysis
