// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/statistics.hpp"

#include <cmath>
#include <numbers>

namespace tacto::schema {
namespace {

// The quantile for 1 and 2 degrees of freedom has a closed form in the probability p.
double exact_student_t(double freedom, double normal) {
  const double p = 0.5 * std::erfc(-normal / std::numbers::sqrt2);
  if (freedom <= 1) return std::tan(std::numbers::pi * (p - 0.5));
  return (2 * p - 1) * std::sqrt(2 / (4 * p * (1 - p)));
}

}  // namespace

double student_t(double freedom, double normal) {
  if (freedom <= 2) return exact_student_t(freedom, normal);
  const double z = normal, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z, z9 = z7 * z * z;
  const double first = (z3 + z) / 4, second = (5 * z5 + 16 * z3 + 3 * z) / 96;
  const double third = (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / 384;
  const double fourth = (79 * z9 + 776 * z7 + 1482 * z5 - 1920 * z3 - 945 * z) / 92160;
  return z + (first + (second + (third + fourth / freedom) / freedom) / freedom) / freedom;
}

}  // namespace tacto::schema
