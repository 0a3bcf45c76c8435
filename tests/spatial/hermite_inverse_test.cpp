// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/hermite_inverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "spatial/reference/exact_hermite.hpp"

namespace tacto::spatial {
namespace {

struct Knots {
  std::vector<double> t, x;
};

// A finger at uneven speed, seen by an encoder of 1 um; x in m, t in samples.
Knots finger(double offset_m) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> counts(1, 9);
  Knots knots;
  std::int64_t count = 0;
  for (int i = 0; i < 2000; ++i, count += counts(random)) {
    knots.t.push_back(i);
    knots.x.push_back(offset_m + static_cast<double>(count) * 1e-6);
  }
  return knots;
}

// Speeds over 12 decades from knot to knot: derivatives near 0 at knots, and cubics near a triple root.
Knots jerky() {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> decades(-12, 0);
  Knots knots{{0}, {0}};
  for (int i = 1; i < 2000; ++i) {
    knots.t.push_back(knots.t.back() + std::pow(10, decades(random) / 4));
    knots.x.push_back(knots.x.back() + 1e-3 * std::pow(10, decades(random)));
  }
  return knots;
}

std::vector<double> targets(const Knots& knots, std::size_t count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> between(knots.x.front(), knots.x.back());
  std::vector<double> at(count);
  for (double& x : at) x = between(random);
  std::ranges::sort(at);
  return at;
}

// The largest error of position, in m.
double position_error(const Knots& knots, const std::vector<double>& at) {
  const HermiteInverse inverse(knots.t, knots.x);
  const reference::ExactHermite exact(knots.t, knots.x);
  std::vector<double> t(at.size());
  inverse.evaluate_sorted(at, t);
  double error = 0;
  for (std::size_t i = 0; i < at.size(); ++i)
    error = std::max(error, static_cast<double>(std::abs(exact.value(t[i]) - at[i])));
  return error;
}

// The largest error of time, in segments.
double time_error(const Knots& knots, const std::vector<double>& at) {
  const HermiteInverse inverse(knots.t, knots.x);
  const reference::ExactHermite exact(knots.t, knots.x);
  double error = 0;
  for (const double x : at) {
    const auto above = std::upper_bound(knots.x.begin() + 1, knots.x.end() - 1, x) - knots.x.begin();
    const double width =
        knots.t[static_cast<std::size_t>(above)] - knots.t[static_cast<std::size_t>(above) - 1];
    error = std::max(error, std::abs(static_cast<double>(exact.inverse(x)) - inverse(x)) / width);
  }
  return error;
}

TEST(HermiteInverse, AgreesWithBisectionInLongDouble) {
  const Knots knots = finger(0);
  // Required: 1e-9 m. A step of 1e-10 of a segment of at most 9 um is 1e-15 m.
  EXPECT_LT(position_error(knots, targets(knots, 5000)), 1e-14);
  EXPECT_LT(time_error(knots, targets(knots, 500)), 1e-10);
}

TEST(HermiteInverse, HoldsWhereTheDerivativeNearsZero) {
  const Knots knots = jerky();
  EXPECT_LT(position_error(knots, targets(knots, 5000)), 1e-12);
}

TEST(HermiteInverse, HoldsAKilometreAway) {
  const Knots knots = finger(1000);
  // One unit in the last place of 1000 m is 1.1e-13 m.
  EXPECT_LT(position_error(knots, targets(knots, 2000)), 5e-13);
}

TEST(HermiteInverse, SolvesASegmentWithATripleRoot) {
  // y = (2u - 1)^3, flat at its middle: m0 = m1 = 6 = 3 (y1 - y0).
  const HermiteSegment segment{-1, 1, 6, 6};
  for (const double u : {0.01, 0.3, 0.4999, 0.5, 0.50001, 0.9})
    EXPECT_NEAR(segment.value(solve_segment(segment, segment.value(u))), segment.value(u), 1e-15) << u;
}

TEST(HermiteInverse, AgreesInTheFirstAndTheLastSegment) {
  Knots knots = finger(0);
  for (const std::size_t count : {2, 3, 50}) {
    const Knots few{{knots.t.begin(), knots.t.begin() + count}, {knots.x.begin(), knots.x.begin() + count}};
    std::vector<double> at;
    for (const std::size_t i : {std::size_t{0}, count - 2})
      for (const double part : {0.001, 0.4, 0.999}) at.push_back(few.x[i] + part * (few.x[i + 1] - few.x[i]));
    std::ranges::sort(at);
    EXPECT_LT(position_error(few, at), 1e-14) << count;
    EXPECT_LT(time_error(few, at), 1e-10) << count;
  }
}

TEST(HermiteInverse, StaysWithinItsKnots) {
  const Knots knots = finger(0);
  const HermiteInverse inverse(knots.t, knots.x);
  EXPECT_EQ(inverse(knots.x.front() - 1), knots.t.front());
  EXPECT_EQ(inverse(knots.x.back() + 1), knots.t.back());
  const std::vector<double> outside{knots.x.front() - 1, knots.x.back(), knots.x.back() + 1};
  std::vector<double> t(outside.size());
  inverse.evaluate_sorted(outside, t);
  EXPECT_EQ(t, (std::vector{knots.t.front(), knots.t.back(), knots.t.back()}));
  for (std::size_t i = 0; i < knots.x.size(); ++i) EXPECT_EQ(inverse(knots.x[i]), knots.t[i]);
}

}  // namespace
}  // namespace tacto::spatial
