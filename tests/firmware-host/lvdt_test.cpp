// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/bench/lvdt.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware-host/sim_stream.hpp"
#include "tests/firmware-host/sine_fit.hpp"

namespace tacto::firmware_host {
namespace {

constexpr double kRateHz = 10e3;

double metres(const Lvdt& lvdt, std::int32_t code) {
  return code * lvdt.converter().scale() + lvdt.centre_m();
}

class LvdtSine : public testing::TestWithParam<double> {};

// First order: 1 / (1 + i f / f_c). Linear interpolation of the position between samples multiplies the sine
// by sinc^2 and adds images: at 300 Hz 1e-3 of it, of which the low-pass keeps 2 %. A code is 0.15 um.
TEST_P(LvdtSine, GainAndPhaseAreTheClosedForm) {
  const double frequency_hz = GetParam();
  Lvdt lvdt({.range_m = 10e-3, .bandwidth_hz = 200, .noise_m = 0}, 0, 0, kRateHz, false, Random(1, 0));
  std::vector<double> seen_m;
  for (int i = 1; i <= 3000; ++i)
    seen_m.push_back(
        metres(lvdt, lvdt.step(4e-3 * std::cos(2 * std::numbers::pi * frequency_hz * i / kRateHz))));
  const auto measured = tests::sine_fit(std::span(seen_m).subspan(1000), 1001, kRateHz, frequency_hz) / 4e-3;
  const double turn = std::numbers::pi * frequency_hz / kRateHz;
  const auto target = std::pow(std::sin(turn) / turn, 2) / std::complex<double>(1, frequency_hz / 200);
  EXPECT_NEAR(std::abs(measured / target - 1.0), 0, 3e-5);
}

INSTANTIATE_TEST_SUITE_P(Band, LvdtSine, testing::Values(5, 50, 200, 300));

TEST(Lvdt, AMovingFingerIsSeenLateByTheTimeConstant) {
  Lvdt lvdt({.range_m = 60e-3, .bandwidth_hz = 200, .noise_m = 0}, 20e-3, 0, kRateHz, false, Random(1, 0));
  double seen_m = 0;
  for (int i = 1; i <= 2000; ++i) seen_m = metres(lvdt, lvdt.step(0.05 * i / kRateHz));
  EXPECT_NEAR(seen_m, 0.05 * (0.2 - 1 / (2 * std::numbers::pi * 200)), 0.5 * 60e-3 / 65536);
}

TEST(Lvdt, ItsNoiseAndItsRangeAreWhatIsAskedFor) {
  Lvdt lvdt({.range_m = 60e-3, .bandwidth_hz = 200, .noise_m = 5e-6}, 20e-3, 20e-3, kRateHz, true,
            Random(1, 0));
  double squares = 0;
  for (int i = 0; i < 20000; ++i) squares += std::pow(metres(lvdt, lvdt.step(20e-3)) - 20e-3, 2);
  EXPECT_NEAR(std::sqrt(squares / 20000), 5e-6, 0.02 * 5e-6);
  for (int i = 0; i < 200; ++i) lvdt.step(70e-3);
  EXPECT_GT(lvdt.converter().clipped(), 0U);
  EXPECT_NEAR(lvdt.converter().most(), 30e-3, 1e-6);
}

// Beside the encoder: the same path, measured by another instrument.
TEST(Lvdt, InTheDeviceItFollowsTheEncodersPath) {
  const auto encoder = tests::stream_of("sim:surface=C", 1),
             lvdt = tests::stream_of("sim:surface=C,position=lvdt", 1);
  const auto& channel = lvdt.capabilities.channels[1];
  EXPECT_EQ(channel.quantity, "position");
  EXPECT_NE(channel.source.find("LVDT"), std::string::npos);
  EXPECT_NEAR(*channel.range_max - *channel.range_min, 60e-3, 1e-6);
  EXPECT_NE(lvdt.capabilities.simulated.find("LVDT of 60 mm"), std::string::npos);
  const auto exact_m = encoder.channel(tests::kPosition), seen_m = lvdt.channel(tests::kPosition);
  for (std::size_t i = 0; i < exact_m.size(); ++i) {
    ASSERT_EQ(lvdt.codes[4 * i + 1] & 0xFFFF, 0) << "16 bits";
    // Tolerance: a lag of 0.8 ms at 60 mm/s, a count of the encoder, six standard deviations of 2 um.
    ASSERT_NEAR(seen_m[i], exact_m[i], 48e-6 + 1e-6 + 12e-6) << i;
    ASSERT_EQ(lvdt.codes[4 * i], encoder.codes[4 * i]) << "the rest is the same to the bit";
  }
}

}  // namespace
}  // namespace tacto::firmware_host
