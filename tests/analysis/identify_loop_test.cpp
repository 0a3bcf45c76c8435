// SPDX-License-Identifier: GPL-3.0-or-later
// The hysteresis of slow loops: against the emulated bender, whose operator has 32 evenly weighted play
// operators behind the electrical pole, while the fitted one has 12 with free weights before it; and against
// an operator of its own kind.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/measure/excitation.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "playback/model/hysteresis_inverse.hpp"
#include "tests/faults.hpp"

namespace tacto::analysis {
namespace {

constexpr double kLoopRateHz = 2e3;
// Delay of the tray, and of a drive that is held for a sample.
double delay_s() {
  return delay_at_rest_s(schema::read_transducer("wiertlewski2011").value()) + 0.5 / kLoopRateHz;
}

constexpr double kLoopTurns = 6.283185307179586;

schema::Transducer loop_preset() {
  return schema::read_transducer("wiertlewski2011").value();
}

std::vector<double> drive_of(double amplitude_v) {
  const auto drive = slow_loops(kLoopRateHz, amplitude_v);
  return {drive.begin(), drive.end()};
}

std::vector<double> tray_under(const std::vector<double>& drive_v, double opening) {
  firmware_host::ActuatedTray tray(loop_preset(), kLoopRateHz,
                                   {.second_mode = {}, .finger_load = {}, .hysteresis = opening});
  std::vector<double> x = firmware_host::displacement_under(tray, drive_v);
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0, 20e-9);
  for (double& value : x) value += normal(random);
  return x;
}

double part_left(const std::vector<double>& target, const std::vector<double>& is) {
  double left = 0, whole = 0;
  for (std::size_t i = 0; i < is.size(); ++i)
    left += std::pow(target[i] - is[i], 2), whole += std::pow(target[i], 2);
  return std::sqrt(left / whole);
}

TEST(IdentifyLoop, TheEmulatedBendersSixteenPercent) {
  const auto drive = drive_of(5);
  const auto x = tray_under(drive, 0.16);
  const LoopFit fit = fit_loops(drive, x, kLoopRateHz, delay_s(), 5).value();
  EXPECT_NEAR(fit.opening, 0.16, 0.002);  // its own definition; 32 play operators round it by 1/1000
  EXPECT_NEAR(fit.lag_rad * 360 / kLoopTurns, 7.7, 0.2);  // firmware-host/DECISIONS.md: its fundamental
  EXPECT_NEAR(fit.gain_m_per_v / 20e-6, 1, 0.005);        // a full swing keeps the linear gain
  EXPECT_TRUE(fit.usable);
  EXPECT_LT(fit.residual_part, 0.005);
  EXPECT_GT(fit.linear_residual_part, 0.08);
  // Another path than that of the fit: small loops within a large one.
  std::vector<double> other;
  for (int i = 0; i < 8000; ++i) {
    const double t = i / kLoopRateHz;
    other.push_back(std::min(1.0, t) *
                    (3.5 * std::sin(kLoopTurns * 0.9 * t) + 1.4 * std::sin(kLoopTurns * 3.1 * t)));
  }
  const auto played = playback::played_through(fit.hysteresis, other);
  std::vector<double> by_operator, by_line;
  for (std::size_t i = 0; i < played.size(); ++i) {
    by_operator.push_back(20e-6 * played[i]);
    by_line.push_back(20e-6 * other[i]);
  }
  const auto truth = tray_under(other, 0.16);
  // The residual is the pole's lag, 2.6 ms at 3 Hz: 3 %.
  EXPECT_LT(part_left(truth, by_operator), 0.05);
  EXPECT_GT(part_left(truth, by_line), 3 * part_left(truth, by_operator));
}

TEST(IdentifyLoop, ATrayWithoutOneHasNone) {
  const auto drive = drive_of(5);
  const LoopFit fit = fit_loops(drive, tray_under(drive, 0), kLoopRateHz, delay_s(), 5).value();
  EXPECT_LT(fit.opening, 0.001);
  EXPECT_TRUE(fit.usable);
  EXPECT_NEAR(fit.hysteresis.weights.front(), 1, 0.002);
}

TEST(IdentifyLoop, AnOperatorOfItsKindComesBack) {
  const auto drive = drive_of(4);
  schema::Hysteresis truth;
  for (std::size_t i = 0; i < kThresholds; ++i) {
    truth.thresholds_v.push_back(4.0 * static_cast<double>(i) / kThresholds);
    truth.weights.push_back(i == 0 ? 0.7 : 0.02 * static_cast<double>(i % 4));
  }
  auto x = playback::played_through(truth, drive);
  for (double& value : x) value = 3e-6 + 17e-6 * value;
  const LoopFit fit = fit_loops(drive, x, kLoopRateHz, 0, 4).value();
  const double scale = fit.gain_m_per_v / 17e-6;
  for (std::size_t i = 0; i < kThresholds; ++i)
    EXPECT_NEAR(fit.hysteresis.weights[i] * scale, truth.weights[i], 1e-6) << i;
  double kept = 0;
  for (std::size_t i = 0; i < kThresholds; ++i)
    kept += fit.hysteresis.weights[i] * (4 - fit.hysteresis.thresholds_v[i]);
  EXPECT_NEAR(kept, 4, 1e-9);
}

TEST(IdentifyLoop, RefusesWhatIsNoLoop) {
  const std::vector<double> few(20, 1.0), up = [] {
    std::vector<double> ramp(500);
    std::iota(ramp.begin(), ramp.end(), 0.0);
    return ramp;
  }();
  EXPECT_EQ(fit_loops(few, few, 1e3, 0, 5).error().kind, schema::ErrorKind::unsuitable);
  EXPECT_TRUE(tests::fails(fit_loops(up, up, 1e3, 0, 5), schema::ErrorKind::unsuitable, "loop"));
  auto broken = drive_of(1);
  const auto sound = broken;
  broken[77] = std::nan("");
  EXPECT_NE(schema::message(fit_loops(sound, broken, kLoopRateHz, 0, 5).error()).find("sample 78"),
            std::string::npos);
}

}  // namespace
}  // namespace tacto::analysis
