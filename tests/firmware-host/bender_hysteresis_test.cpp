// SPDX-License-Identifier: GPL-3.0-or-later
// The hysteresis operator against known properties of Prandtl-Ishlinskii loops.
#include "firmware-host/sim/physics/bender_hysteresis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace tacto::firmware_host {
namespace {

constexpr double kAmplitude = 100, kOpening = 0.16;
constexpr int kPlays = BenderHysteresis::kPlays;

class Hysteresis : public testing::Test {
 protected:
  // Moves to u in steps of about `step`; returns y there.
  double go(double u, double step = 0.5) {
    const int count = std::max(1, static_cast<int>(std::ceil(std::abs(u - u_) / step)));
    const double from = u_;
    for (int i = 1; i <= count; ++i) operator_.settle(from + (u - from) * i / count);
    u_ = u;
    return y();
  }
  double y() const { return operator_.at(u_); }
  // y along a sequence of points.
  std::vector<double> along(const std::vector<double>& points) {
    std::vector<double> values;
    for (const double point : points) values.push_back(go(point));
    return values;
  }
  // Loop area between +-a, by the trapezoidal rule with steps at the kinks of all play operators.
  double area(double a) {
    go(a), go(-a);
    const int steps = 64 * kPlays;
    double sum = 0;
    for (const int way : {1, -1})
      for (int i = 1; i <= steps; ++i) {
        const double before = y(), from = u_;
        sum -= (go(way * a * (2.0 * i / steps - 1), 1e9) + before) / 2 * (u_ - from);
      }
    return sum;
  }

  BenderHysteresis operator_{kOpening, kAmplitude};
  double u_ = 0;
};

// As in the paper's Figure 7: the loop ends on the straight line, and opens by 16 % of its height.
TEST_F(Hysteresis, TheFullLoopEndsOnTheLineAndOpensAsStated) {
  EXPECT_NEAR(go(kAmplitude), kAmplitude, 1e-9);
  const double down = go(0);
  EXPECT_NEAR(go(-kAmplitude), -kAmplitude, 1e-9);
  EXPECT_NEAR(down - go(0), kOpening * 2 * kAmplitude, 1e-9);
}

// The loop of a play operator is a parallelogram of area 4 r (a - r); thresholds (i + 1/2) A / n, weights 4 h
// / n.
TEST_F(Hysteresis, LoopAreasAreTheSumOfTheParallelograms) {
  for (const double a : {100.0, 70.0, 25.0, 3.0}) {
    double target = 0;
    for (int i = 0; i < kPlays; ++i) {
      const double r = (i + 0.5) * kAmplitude / kPlays;
      if (r < a) target += 4 * kOpening / kPlays * 4 * r * (a - r);
    }
    EXPECT_NEAR(area(a), target, 1e-6 * std::max(target, 1.0)) << a;
  }
}

// Rayleigh's law, approximated by 32 play operators: opening over height is proportional to the swing, and a
// branch is a parabola.
TEST_F(Hysteresis, SmallerLoopsOpenInProportion) {
  for (const double a : {80.0, 50.0, 25.0}) {
    go(a), go(-a), go(a);
    const double top = y(), down = go(0), bottom = go(-a), up = go(0);
    const double h = kOpening, swing = a / kAmplitude;
    EXPECT_NEAR((down - up) / (top - bottom), h * swing / (1 - 2 * h + 2 * h * swing), 2e-3) << a;
  }
}

TEST_F(Hysteresis, ASmallSwingSeesTheStraightGain) {
  const double r = kAmplitude / kPlays / 2;
  EXPECT_NEAR(go(0.99 * r) / u_, 1 - 2 * kOpening, 1e-12);
  EXPECT_NEAR(go(-0.99 * r) / u_, 1 - 2 * kOpening, 1e-12);
}

TEST_F(Hysteresis, TheRateChangesNothing) {
  const auto coarse = along({60, -20, 35, -80, 10});
  operator_ = BenderHysteresis(kOpening, kAmplitude), u_ = 0;
  std::vector<double> fine;
  for (const double u : {60.0, -20.0, 35.0, -80.0, 10.0}) fine.push_back(go(u, 0.001));
  for (std::size_t i = 0; i < fine.size(); ++i) EXPECT_NEAR(fine[i], coarse[i], 1e-12);
}

// Madelung's rules: a minor loop closes where it began, and the path after it is as if the loop had not
// happened.
TEST_F(Hysteresis, MinorLoopsCloseAndAreForgotten) {
  along({100, -100, 40});
  const double turned = y();
  EXPECT_NE(go(-10), turned);
  EXPECT_NEAR(go(40), turned, 1e-12);
  const double onward = go(70);
  operator_ = BenderHysteresis(kOpening, kAmplitude), u_ = 0;
  along({100, -100});
  EXPECT_NEAR(go(70), onward, 1e-12);
}

// Congruency: minor loops between the same ends have the same shape for any history.
TEST_F(Hysteresis, MinorLoopsBetweenEqualEndsAreCongruent) {
  along({100, -100, 30, -30, 30});
  const double high = y() - go(-30);
  along({100, 30, -30, 30});
  EXPECT_NEAR(y() - go(-30), high, 1e-12);
}

// Masing: a branch from any turning point is the virgin curve, twice as large.
TEST_F(Hysteresis, BranchesAreTheVirginCurveDoubled) {
  std::vector<double> virgin;
  for (int i = 1; i <= 50; ++i) virgin.push_back(go(i));
  operator_ = BenderHysteresis(kOpening, kAmplitude), u_ = 0;
  const double turned = go(kAmplitude);
  for (int i = 1; i <= 50; ++i) EXPECT_NEAR(turned - go(kAmplitude - 2 * i), 2 * virgin[i - 1U], 1e-9);
}

TEST_F(Hysteresis, LookingAheadChangesNothing) {
  go(60);
  const double before = y();
  EXPECT_GT(operator_.at(90), before);
  EXPECT_LT(operator_.at(-90), before);
  EXPECT_EQ(y(), before);
}

TEST(BenderHysteresis, WithNoneNothingIsChangedToTheBit) {
  BenderHysteresis none(0, 100);
  for (const double u : {0.1, -37.3, 99.0}) {
    none.settle(-u);
    EXPECT_EQ(none.at(u), u);
  }
}

}  // namespace
}  // namespace tacto::firmware_host
