// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/demo/demo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tacto::analysis {
namespace {

constexpr double kRateHz = 10e3;

// Tones well inside the band, delayed by `delay_s` and multiplied by `gain`.
schema::TimeSignal tones(double delay_s, double gain, double hum = 0) {
  schema::TimeSignal signal{kRateHz, 0, {}};
  for (int i = 0; i < 20000; ++i) {
    const double t = i / kRateHz - delay_s;
    double value = 0;
    for (const double hz : {40.0, 110.0, 270.0, 430.0}) value += std::sin(2 * std::numbers::pi * hz * t);
    signal.values.push_back(gain * value + hum * std::sin(2 * std::numbers::pi * 1500 * t));
  }
  return signal;
}

TEST(ReplayError, FindsTheDelayToATenthOfAMicrosecond) {
  for (const double delay_s : {0.0, 50e-6, 1.2345e-3, -2e-3}) {
    const auto error = replay_error(tones(delay_s, 1), tones(0, 1), {}, 0.2);
    EXPECT_NEAR(error.delay_s, delay_s, 1.5e-7);
  }
}

TEST(ReplayError, IsTheRelativeErrorOfAGain) {
  const auto error = replay_error(tones(1e-3, 1.01), tones(0, 1), {}, 0.2);
  EXPECT_NEAR(error.error_db, -40, 0.1);  // 1 %; the tones end within the padding, whose ringing is excluded
  EXPECT_NEAR(error.target_rms, std::sqrt(2.0), 0.01);
}

TEST(ReplayError, LeavesOutWhatLiesOutsideTheBand) {
  const auto error = replay_error(tones(0, 1, 10), tones(0, 1), {}, 0.2);
  EXPECT_LT(error.error_db, -60);
}

TEST(ReplayError, SeesAnotherSignal) {
  auto other = tones(0, 1);
  for (std::size_t i = 0; i < other.values.size(); ++i) other.values[i] = i % 137 == 0 ? 5 : 0;
  EXPECT_GT(replay_error(other, tones(0, 1), {}, 0.2).error_db, -3);
}

}  // namespace
}  // namespace tacto::analysis
