// SPDX-License-Identifier: GPL-3.0-or-later
// Converter, noise floor, encoder and load cell, measured from the frames.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "firmware-host/sim/physics/converter.hpp"
#include "tests/firmware-host/sim_stream.hpp"

namespace tacto::firmware_host {
namespace {

using tests::stream_of;

double mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

TEST(Converter, RoundsClipsAndCounts) {
  Converter converter(16, 10);
  const auto code = [&](double v) { return converter.convert(v) >> 16; };
  EXPECT_EQ(code(0), 0);
  EXPECT_EQ(code(10.0 / 32768), 1);
  EXPECT_EQ(code(-0.51 * 10 / 32768), -1);
  EXPECT_EQ(code(-10), -32768);
  EXPECT_EQ(converter.clipped(), 0U);
  EXPECT_EQ(code(10), 32767);
  EXPECT_EQ(code(-11), -32768);
  EXPECT_EQ(converter.clipped(), 2U);
  EXPECT_EQ(converter.convert(5) * converter.scale(), 5);
  EXPECT_EQ(Converter(32, 1).convert(-1), INT32_MIN);
}

TEST(SimInstruments, CodesAreSixteenBitsLeftJustified) {
  const auto stream = stream_of("sim:surface=D", 0.5);
  std::set<std::int32_t> codes;
  for (std::size_t i = 0; i < stream.codes.size(); i += 4) {
    ASSERT_EQ(stream.codes[i] & 0xFFFF, 0);
    codes.insert(stream.codes[i] >> 16);
  }
  std::int32_t step = INT32_MAX, before = INT32_MIN;
  for (const std::int32_t code : codes) {
    if (before != INT32_MIN) step = std::min(step, code - before);
    before = code;
  }
  EXPECT_EQ(step, 1);
  EXPECT_NEAR(65536 * stream.capabilities.channels[0].scale, 20.0 / 65536, 1e-12);
}

TEST(SimInstruments, WithFingerUpAndNoNoiseThereIsNothing) {
  const auto stream = stream_of("sim:finger=up,noise=off", 1);
  for (std::size_t i = 0; i < stream.codes.size(); i += 4) {
    ASSERT_EQ(stream.codes[i], 0);
    ASSERT_EQ(stream.codes[i + 2], 0);
    ASSERT_EQ(stream.codes[i + 3], 0);
  }
}

// 25 uN/sqrt(Hz) at 26 V/N in the middle of the band, in 0 to 5 kHz. Tolerance: 4 % between 100 Hz, where 26
// V/N is stated, and the gain of the stiffness alone (the resonance raises 100 Hz by 3.4 %), 1 % for
// statistics.
TEST(SimInstruments, FingerUpLeavesThePapersNoiseFloor) {
  const auto noise_v = stream_of("sim:finger=up,seed=5", 3).channel(tests::kSensor);
  const double density_v = std::sqrt(mean_square(noise_v) / 5000);
  EXPECT_NEAR(density_v / 26, 25e-6, 0.05 * 25e-6);
  std::vector<double> differences;  // white: twice the variance
  for (std::size_t i = 1; i < noise_v.size(); ++i) differences.push_back(noise_v[i] - noise_v[i - 1]);
  EXPECT_NEAR(mean_square(differences) / mean_square(noise_v), 2, 0.05);
}

TEST(SimInstruments, AStrokeIsAtLeastTwentyDecibelsAboveFingerUp) {
  const double up = mean_square(stream_of("sim:surface=E,finger=up", 1).channel(tests::kSensor));
  const double down = mean_square(stream_of("sim:surface=E", 1).channel(tests::kSensor));
  EXPECT_GT(10 * std::log10(down / up), 20);
}

TEST(SimInstruments, TheEncoderCountsThePathInItsQuantum) {
  const auto coarse = stream_of("sim:encoder_quantum=10um", 1), fine = stream_of("sim:", 1);
  EXPECT_DOUBLE_EQ(coarse.capabilities.channels[1].scale, 10e-6);
  for (std::size_t i = 1; i < fine.codes.size(); i += 4) ASSERT_EQ(coarse.codes[i], fine.codes[i] / 10);
}

// The same sensor for both: friction makes the net force 0.92 of the normal force during a steady stroke.
TEST(SimInstruments, TheLoadCellFeelsLoadAndFriction) {
  const auto stream = stream_of("sim:surface=flat", 0.7);
  const auto normal_n = stream.channel(tests::kNormal), net_n = stream.channel(tests::kNet);
  double normal = 0, net = 0;
  for (std::size_t i = 3000; i < 7000; ++i) normal += normal_n[i] / 4000, net += net_n[i] / 4000;
  EXPECT_NEAR(normal, 0.5, 0.15);
  EXPECT_NEAR(net / normal, 0.92, 0.01);
  for (std::size_t i = 1; i < 7000; ++i) {
    if (i % 10 != 0) {
      ASSERT_EQ(normal_n[i], normal_n[i - 1]) << "held between readings, " << i;
    }
  }
}

TEST(SimInstruments, ClippingIsCounted) {
  const auto stream = stream_of("sim:surface=B,load=3N", 0.5);
  std::uint64_t at_the_end = 0;
  for (std::size_t i = 0; i < stream.codes.size(); i += 4)
    at_the_end += (stream.codes[i] >> 16) == 32767 || (stream.codes[i] >> 16) == -32768;
  EXPECT_GT(stream.counts.clipped, 0U);
  EXPECT_EQ(stream.counts.clipped, at_the_end);
}

}  // namespace
}  // namespace tacto::firmware_host
