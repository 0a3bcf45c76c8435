// SPDX-License-Identifier: GPL-3.0-or-later
// Student's t against the printed table (Abramowitz and Stegun, table 26.10), one- and two-sided,
// within the table's rounding.
#include "data-schema/base/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tacto::schema {
namespace {

struct Row {
  double freedom, two_sided_95, one_sided_95;
};

TEST(Statistics, StudentsTIsTheTables) {
  constexpr Row kTable[] = {{1, 12.706, 6.314}, {2, 4.303, 2.920},  {3, 3.182, 2.353},
                            {5, 2.571, 2.015},  {20, 2.086, 1.725}, {120, 1.980, 1.658}};
  for (const Row& row : kTable) {
    EXPECT_NEAR(student_t(row.freedom, kTwoSided95), row.two_sided_95, 5e-4) << row.freedom;
    EXPECT_NEAR(student_t(row.freedom, kOneSided95), row.one_sided_95, 5e-4) << row.freedom;
  }
  EXPECT_NEAR(student_t(INFINITY, kTwoSided95), 1.959964, 5e-7);
  EXPECT_TRUE(std::isnan(student_t(NAN, kTwoSided95)));
}

TEST(Statistics, UpperMedianOfAnEvenNumberIsTheUpperOfTwo) {
  std::vector<double> odd{5, 1, 3};
  std::vector<int> even{4, 1, 3, 2};
  EXPECT_EQ(upper_median(std::span(odd)), 3.0);
  EXPECT_EQ(upper_median(std::span(even)), 3);
}

}  // namespace
}  // namespace tacto::schema
