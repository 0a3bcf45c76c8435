// SPDX-License-Identifier: GPL-3.0-or-later
// The integrated actuator against the closed form of its transfer function.
#include "firmware-host/sim/bench/actuated_tray.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/firmware-host/sine_fit.hpp"

namespace tacto::firmware_host {
namespace {

using Complex = std::complex<double>;
constexpr double kTickHz = 10e3;

schema::Transducer preset() {
  return *schema::read_transducer("wiertlewski2011");
}

Complex held_response(double frequency_hz, bool filtered) {
  const double turns = frequency_hz / kTickHz;
  const double size = turns == 0 ? 1 : std::sin(std::numbers::pi * turns) / (std::numbers::pi * turns);
  const Complex hold = std::polar(size, -std::numbers::pi * turns);
  const Complex tray = hold * schema::actuator_response(preset(), frequency_hz);
  return filtered ? tray * schema::butterworth3_response(600, frequency_hz) : tray;
}

// The response at the ticks to a sine that a converter holds: that of the sine and of all its images, which
// alias onto it.
Complex folded_response(double frequency_hz, bool filtered) {
  Complex sum;
  for (int image = -100; image <= 100; ++image)
    sum += held_response(frequency_hz + image * kTickHz, filtered);
  return sum;
}

Complex measured_response(double frequency_hz, ActuatedTray& tray) {
  std::vector<double> drive_v;
  for (int i = 0; i < 5000; ++i)
    drive_v.push_back(2 * std::cos(2 * std::numbers::pi * frequency_hz * i / kTickHz));
  const auto displacement_m = displacement_under(tray, drive_v);
  return tests::sine_fit(std::span(displacement_m).subspan(3000), 3000, kTickHz, frequency_hz) / 2.0;
}

class TraySine : public testing::TestWithParam<double> {};

// Tolerance: the step's error, (w h)^4 / 120 = 1e-7 per radian at 800 Hz times the resonance's Q of 5, and
// the images beyond the hundredth.
TEST_P(TraySine, GainAndPhaseAreTheClosedForm) {
  ActuatedTray tray(preset(), kTickHz);
  const Complex ratio = measured_response(GetParam(), tray) / folded_response(GetParam(), false);
  EXPECT_NEAR(std::abs(ratio), 1, 2e-6);
  EXPECT_NEAR(std::arg(ratio), 0, 2e-6);
}

TEST_P(TraySine, TheReconstructionFilterComesOnTop) {
  ActuatedTray tray(preset(), kTickHz, {.reconstruction_cutoff_hz = 600});
  const Complex ratio = measured_response(GetParam(), tray) / folded_response(GetParam(), true);
  EXPECT_NEAR(std::abs(ratio), 1, 2e-6);
  EXPECT_NEAR(std::arg(ratio), 0, 2e-6);
}

INSTANTIATE_TEST_SUITE_P(Band, TraySine, testing::Values(10, 15, 100, 300, 500, 530, 545, 800));

TEST(ActuatedTray, AStepEndsAtTheStaticGain) {
  ActuatedTray tray(preset(), kTickHz);
  EXPECT_EQ(tray.tick(1), 0);
  for (int i = 0; i < 2000; ++i) tray.tick(1);
  EXPECT_NEAR(tray.displacement_m(), schema::actuator_response(preset(), 0).real(), 1e-15);
}

TEST(ActuatedTray, AFingerPushesItLikeASpring) {
  ActuatedTray tray(preset(), kTickHz);
  for (int i = 0; i < 2000; ++i) tray.tick(0, 0.5);
  EXPECT_NEAR(tray.displacement_m(), 0.5 / (76470 + 4050), 1e-12);
}

TEST(ActuatedTray, SubstepsFollowTheTickRate) {
  ActuatedTray slow(preset(), 2e3), fast(preset(), 20e3);
  for (int i = 0; i < 10; ++i) slow.tick(1);
  for (int i = 0; i < 100; ++i) fast.tick(1);
  EXPECT_NEAR(slow.displacement_m(), fast.displacement_m(), 1e-6 * fast.displacement_m());
}

TEST(ActuatedTray, DriveBeyondTheLimitIsHeldAndCounted) {
  ActuatedTray limited(preset(), kTickHz), at_limit(preset(), kTickHz);
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(limited.tick(i % 2 == 0 ? 7 : -5), at_limit.tick(i % 2 == 0 ? 5 : -5));
  EXPECT_EQ(limited.limited_ticks(), 25U);
  EXPECT_EQ(at_limit.limited_ticks(), 0U);
}

TEST(ActuatedTray, WhatIsNoNumberDrivesNothing) {
  ActuatedTray tray(preset(), kTickHz);
  for (int i = 0; i < 50; ++i) tray.tick(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(tray.displacement_m(), 0);
  EXPECT_EQ(tray.limited_ticks(), 50U);
}

}  // namespace
}  // namespace tacto::firmware_host
