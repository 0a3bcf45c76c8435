// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/hermite.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/spatial/golden_file.hpp"

namespace tacto::spatial {
namespace {

struct GoldenCurve {
  std::string name;
  std::vector<double> x, y, slopes, at, values;
};

std::vector<GoldenCurve> golden_curves() {
  GoldenFile file("pchip.txt");
  std::vector<GoldenCurve> curves;
  for (std::string name; file.next(name);) {
    GoldenCurve curve{name, file.numbers(), file.numbers(), {}, {}, {}};
    curve.slopes = file.numbers();
    curve.at = file.numbers();
    curve.values = file.numbers();
    curves.push_back(std::move(curve));
  }
  return curves;
}

double largest(const std::vector<double>& values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

// Some rounding errors of doubles: both sides use about 20 operations.
constexpr double kRounding = 1e-14;

TEST(Hermite, EqualsSciPy) {
  const auto curves = golden_curves();
  ASSERT_EQ(curves.size(), 7U);
  for (const GoldenCurve& golden : curves) {
    const HermiteCurve curve(golden.x, golden.y);
    const auto slopes = hermite_slopes(golden.x, golden.y);
    for (std::size_t i = 0; i < slopes.size(); ++i)
      EXPECT_NEAR(slopes[i], golden.slopes[i], kRounding * largest(golden.slopes)) << golden.name << i;
    for (std::size_t i = 0; i < golden.at.size(); ++i)
      EXPECT_NEAR(curve(golden.at[i]), golden.values[i], kRounding * largest(golden.y)) << golden.name << i;
  }
}

TEST(Hermite, SortedWalkGivesTheSameAsSearch) {
  for (const GoldenCurve& golden : golden_curves()) {
    const HermiteCurve curve(golden.x, golden.y);
    std::vector<double> walked(golden.at.size());
    curve.evaluate_sorted(golden.at, walked);
    for (std::size_t i = 0; i < walked.size(); ++i) EXPECT_EQ(walked[i], curve(golden.at[i])) << golden.name;
  }
}

TEST(Hermite, EvenKnotsGiveTheSameAsUnevenCode) {
  std::vector<double> x, y;
  for (int i = 0; i < 50; ++i) {
    x.push_back(-1 + 0.125 * i);
    y.push_back(std::sin(0.4 * i) + (i % 7 == 0 ? 0.3 : 0));
  }
  const HermiteCurve general(x, y);
  const UniformHermiteCurve even(-1, 0.125, y);
  for (double at = x.front(); at <= x.back(); at += 0.0173) EXPECT_NEAR(even(at), general(at), kRounding);
  EXPECT_NEAR(even(x.back()), y.back(), kRounding);
}

TEST(Hermite, KeepsItsKnotsToTheBit) {
  const std::vector<double> x = {1000, 1000.001, 1000.5, 1007}, y = {1e30, 2e30, 5e29, -3e30};
  const HermiteCurve curve(x, y);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) EXPECT_EQ(curve(x[i]), y[i]);
}

}  // namespace
}  // namespace tacto::spatial
