// SPDX-License-Identifier: GPL-3.0-or-later
// 95 % intervals of Weber fractions: how often they contain the truth, with 1,000 observers each.
#include <gtest/gtest.h>

#include "tests/analysis/psychometric_observers.hpp"

namespace tacto::analysis {
namespace {

TEST(PsychometricCoverage, IntervalsOfAThousandObserversContainTheTruth) {
  constexpr int kObservers = 1000;
  for (const double weber : {0.155, 0.253}) {
    const int inside = covered(kObservers, weber, {}, 11);
    EXPECT_GE(inside, 930) << weber;
    EXPECT_LE(inside, 980) << weber;
  }
}

// What the prior of the lapse is for: with lapses fixed at 0 the intervals of W are too high.
TEST(PsychometricCoverage, WithoutLapsesIntervalsAreWrong) {
  PsychometricOptions none;
  none.lapse = 0;
  EXPECT_LT(covered(300, 0.155, none, 12), 255);  // 85 %
}

}  // namespace
}  // namespace tacto::analysis
