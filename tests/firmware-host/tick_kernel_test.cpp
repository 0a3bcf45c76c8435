// SPDX-License-Identifier: GPL-3.0-or-later
// The tick kernel against its double-precision reference and against closed forms.
#include "firmware-host/core/kernel/tick_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "firmware-host/core/firmware/sweep_generator.hpp"
#include "firmware-host/reference/exact_tick.hpp"
#include "tests/firmware-host/kernel_workload.hpp"

namespace tacto::core {
namespace {

using firmware_host::ExactTick;
using firmware_host::TickSetup;
using wire::ProfileEnds;

ProfileScale scale_of(const wire::ProfileBegin& b) {
  return {b.samples, b.origin_count, b.at_origin_q32, b.samples_per_count_q32, b.ends};
}

std::vector<float> noise(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<float> values(size);
  for (float& value : values) value = normal(random);
  return values;
}

TickSetup noisy_setup(ProfileEnds ends) {
  TickSetup setup;
  setup.profile = noise(300, 1);
  setup.scale = {300, -70, INT64_C(5) << 31, 1234567890, ends};
  return setup;
}

class ProfileWithEnds : public testing::TestWithParam<ProfileEnds> {};

// Tolerance: six products of samples of up to 4, each rounded to 2^-24, times weights of slopes below 2.
TEST_P(ProfileWithEnds, IsTheDoubleReferenceEverywhere) {
  const TickSetup setup = noisy_setup(GetParam());
  const Profile profile(setup.profile.data(), scale_of(setup.scale));
  const ExactTick exact(setup);
  for (std::int32_t count = -5000; count < 5000; ++count)
    ASSERT_NEAR(profile.at(count), exact.profile_at(count), 4e-6) << count;
}

TEST_P(ProfileWithEnds, FarFromTheOriginNoPlaceIsLost) {
  TickSetup setup = noisy_setup(GetParam());
  setup.scale.samples_per_count_q32 = 1U << 30;
  const Profile profile(setup.profile.data(), scale_of(setup.scale));
  const ExactTick exact(setup);
  for (std::int32_t count = 400'000'000; count < 400'000'900; ++count)
    ASSERT_NEAR(profile.at(count), exact.profile_at(count), 4e-6) << count;
}

TEST_P(ProfileWithEnds, BeyondItsReachItIsZeroAndReadsNothing) {
  const TickSetup setup = noisy_setup(GetParam());
  const ProfileScale scale = scale_of(setup.scale);
  const Profile profile(setup.profile.data(), scale);
  for (const std::int32_t count :
       {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max(),
        scale.origin_count + reach_counts(scale) + 1, scale.origin_count - reach_counts(scale) - 1})
    EXPECT_EQ(profile.at(count), 0) << count;
}

INSTANTIATE_TEST_SUITE_P(Ends, ProfileWithEnds,
                         testing::Values(ProfileEnds::stop, ProfileEnds::loop, ProfileEnds::mirror));

TEST(Profile, AtItsSamplesItIsThem) {
  const std::vector<float> values = noise(50, 2);
  const Profile profile(values.data(), {50, 0, 0, UINT64_C(1) << 32, ProfileEnds::stop});
  for (std::int32_t i = 0; i < 50; ++i) EXPECT_EQ(profile.at(i), values[static_cast<std::size_t>(i)]);
  EXPECT_EQ(profile.at(53), 0);
  EXPECT_EQ(profile.at(-3), 0);
}

// The stated bound of the interpolation, and single precision.
TEST(Profile, ASinusoidIsReadWithinTheStatedError) {
  for (const double period : {10.0, 14.0, 20.0, 50.0, 100.0}) {
    std::vector<float> values(4000);
    const double w = 2 * std::numbers::pi / period;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(std::sin(w * static_cast<double>(i)));
    const Profile profile(values.data(), {4000, 0, 0, UINT64_C(1) << 28, ProfileEnds::stop});
    double worst = 0;
    for (std::int32_t count = 100; count < 60000; ++count)
      worst = std::max(worst, std::abs(profile.at(count) - std::sin(w * count / 16)));
    EXPECT_LT(worst, 0.0026 * std::pow(w, 4) + 0.0032 * std::pow(w, 5) + 2e-7 * 2) << period;
  }
}

// Tolerance: none, because both are the same to the bit.
TEST(Profile, ALoopIsSeamlessForEver) {
  const std::vector<float> values = noise(64, 3);
  const Profile profile(values.data(), {64, 0, 0, UINT64_C(1) << 29, ProfileEnds::loop});
  for (std::int32_t count = -512; count < 0; ++count)
    for (const std::int32_t rounds : {1, 2, 100000})
      ASSERT_EQ(profile.at(count), profile.at(count + rounds * 512));
}

// Eight sections at 20 kHz: an actuator's inverse, poles of radius 0.99 at most.
std::vector<wire::Section> inverse_sections() {
  const wire::Section peak{1.05F, -1.92F, 0.95F, -1.9F, 0.98F},
      low{0.0055F, 0.0111F, 0.0055F, -1.7786F, 0.8008F};
  return {peak, low, peak, {1.3F, -0.4F, 0, -0.1F, 0}, peak, {0.5F, 0.2F, 0.1F, -0.5F, 0.3F}, peak, low};
}

// The same, but three of them are high-passes of 15 Hz: poles of radius 0.9967.
std::vector<wire::Section> high_passed_sections() {
  auto sections = inverse_sections();
  sections[1] = sections[5] = sections[7] = {0.9967F, -1.9934F, 0.9967F, -1.9933F, 0.9934F};
  return sections;
}

TickSetup smooth_setup(std::vector<wire::Section> sections) {
  TickSetup setup;
  setup.profile.resize(tests::kWorkloadSamples);
  float smooth = 0;
  std::mt19937 random(4);
  for (float& value : setup.profile)
    value = smooth = 0.6F * smooth + static_cast<float>(static_cast<int>(random() % 65536) - 32768) / 32768;
  setup.scale = {tests::kWorkloadSamples, -500, INT64_C(1) << 30, 429496730, ProfileEnds::mirror};
  setup.sections = std::move(sections);
  setup.limits = {5, 15708, 0.05F, 0.01F, 100, 200};
  setup.rate_hz = 20e3;
  return setup;
}

// Energy of the difference of the kernel's drive from the reference's, re the reference's, over 2 s of a
// finger that reverses.
double error_db_of(TickSetup setup, double gain) {
  setup.gain = gain;
  TickKernel kernel;
  KernelSetup same;
  same.texture.profile = {setup.profile.data(), scale_of(setup.scale)};
  same.limits = setup.limits;
  same.rate_hz = static_cast<float>(setup.rate_hz);
  same.sections = setup.sections.data();
  same.section_count = static_cast<std::uint8_t>(setup.sections.size());
  kernel.set(same);
  ExactTick exact(setup);
  double error = 0, size = 0;
  std::mt19937 random(5);
  std::int32_t count = 0;
  for (int tick = 0; tick < 40000; ++tick) {
    count += static_cast<std::int32_t>(random() % 4) * (tick / 3000 % 2 == 0 ? 1 : -1);
    const TickOutput output = kernel.tick({count, static_cast<float>(gain), tick < 39000, kNoForce});
    const double exact_v = exact.tick(count, tick < 39000);
    error += (output.drive_v - exact_v) * (output.drive_v - exact_v);
    size += exact_v * exact_v;
    EXPECT_TRUE(output.sound);
  }
  EXPECT_GT(size / 40000, 1e-6) << "a drive of nothing proves nothing";
  return 10 * std::log10(error / size);
}

// The errors that TickKernel states.
TEST(TickKernel, IsWithinTheStatedErrorOfDoublePrecision) {
  const double inverse_db = error_db_of(smooth_setup(inverse_sections()), 1);
  const double limited_db = error_db_of(smooth_setup(inverse_sections()), 10);
  const double high_passed_db = error_db_of(smooth_setup(high_passed_sections()), 1);
  std::printf("error re double precision: %.1f dB, at the limits %.1f dB, with high-passes %.1f dB\n",
              inverse_db, limited_db, high_passed_db);
  EXPECT_LT(inverse_db, -100);
  EXPECT_LT(limited_db, -90);
  EXPECT_LT(high_passed_db, -64);
}

// Stored number; the Cortex-M4F must give the same (cortex_m4_test.py).
TEST(TickKernel, ItsBitsAreTheSameEverywhere) {
  auto workload = std::make_unique<tests::KernelWorkload>();
  tests::DriveFingerprint fingerprint;
  for (std::uint32_t i = 0; i < tests::kWorkloadTicks; ++i) fingerprint.add(workload->tick());
  EXPECT_EQ(fingerprint.value(), tests::kWorkloadFingerprint);
  EXPECT_EQ(workload->flags(), wire::kTickAmplitudeLimited | wire::kTickSlewLimited);
}

TEST(TickKernel, ATexturesBitsAreTheSameEverywhere) {
  auto workload = std::make_unique<tests::TextureWorkload>();
  tests::DriveFingerprint fingerprint;
  float most_v = 0;
  for (std::uint32_t i = 0; i < tests::kWorkloadTicks; ++i) {
    const float drive_v = workload->tick();
    most_v = std::max(most_v, drive_v);
    fingerprint.add(drive_v);
  }
  EXPECT_EQ(fingerprint.value(), tests::kTextureFingerprint);
  EXPECT_GT(most_v, 1);
  EXPECT_EQ(workload->flags(), wire::kTickAmplitudeLimited | wire::kTickSlewLimited |
                                   wire::kTickEnergyLimited | wire::kTickGated | wire::kTickTouching);
}

TEST(SceneKernel, AScenesBitsAreTheSameEverywhere) {
  auto workload = std::make_unique<tests::SceneWorkload>();
  tests::DriveFingerprint fingerprint;
  for (std::uint32_t i = 0; i < tests::kWorkloadTicks; ++i) fingerprint.add(workload->tick());
  EXPECT_EQ(fingerprint.value(), tests::kSceneFingerprint);
  EXPECT_EQ(workload->flags(),
            wire::kTickAmplitudeLimited | wire::kTickSlewLimited | wire::kTickEnergyLimited);
}

TEST(TickKernel, WhatIsNoNumberDrivesTowardsZeroAndIsForgotten) {
  const wire::Section ringing{1, 0, 0, -1.9F, 0.99F};
  KernelSetup setup;
  setup.limits = {5, 5000, 0, 0.001F, 100, 200};
  setup.rate_hz = 1e4F;
  setup.sections = &ringing, setup.section_count = 1;
  TickKernel kernel;
  kernel.set(setup);
  for (int i = 0; i < 100; ++i) kernel.drive(1, true, kNoForce);
  const float before_v = kernel.last_v();
  EXPECT_EQ(before_v, 5);
  const TickOutput lost = kernel.drive(std::numeric_limits<float>::quiet_NaN(), true, kNoForce);
  EXPECT_EQ(lost.drive_v, before_v - 0.5F);
  EXPECT_FALSE(lost.sound);
  TickOutput after;
  for (int i = 0; i < 12; ++i) after = kernel.drive(0, true, kNoForce);
  EXPECT_TRUE(after.sound);
  EXPECT_EQ(kernel.last_v(), 0);
}

// Poles of radius 0.999: from a volt to 1e-25 V in 58,000 ticks, to denormals in 88,000; six of them first
// ring up.
TEST(SectionChain, EndsInSilenceWithoutDenormals) {
  SectionChain chain;
  const std::vector<wire::Section> sections(6, {1, 0.5F, 0.25F, -1.8F * 0.999F, 0.998001F});
  chain.set(sections.data(), 6);
  for (int i = 0; i < 1000; ++i) (void)chain.filter(i % 2 == 0 ? 1.0F : 0.5F);
  int last_sound = 0;
  for (int i = 0; i < 200000; ++i) {
    const float y = chain.filter(0);
    ASSERT_NE(std::fpclassify(y), FP_SUBNORMAL) << i;
    if (y != 0) last_sound = i;
  }
  EXPECT_GT(last_sound, 58000) << "it decays by itself down to 1e-25 V";
  EXPECT_LT(last_sound, 150000) << "and is silent then";
}

TEST(SectionChain, KnowsWhatIsStable) {
  EXPECT_TRUE(is_stable({1, 0, 0, -1.9F, 0.95F}));
  EXPECT_TRUE(is_stable({0, 0, 0, 0, 0}));
  EXPECT_FALSE(is_stable({1, 0, 0, -2, 1}));
  EXPECT_FALSE(is_stable({1, 0, 0, 0, 1}));
  EXPECT_FALSE(is_stable({1, 0, 0, 1.96F, 0.95F}));
  EXPECT_FALSE(is_stable({1, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0}));
  EXPECT_FALSE(is_stable({std::numeric_limits<float>::infinity(), 0, 0, 0, 0}));
}

TEST(Envelope, RisesAndFallsInItsTimesWithoutACorner) {
  Envelope envelope;
  envelope.set(500, 100);
  float before = 0, steepest = 0;
  for (int i = 0; i < 500; ++i) {
    const float weight = envelope.step(true);
    EXPECT_GE(weight, before);
    steepest = std::max(steepest, weight - before);
    before = weight;
  }
  EXPECT_NEAR(before, 1, 1e-5);
  EXPECT_LT(steepest, 1.51F / 500);  // 3/2 of a linear ramp's slope, in the middle
  int ticks = 0;
  for (; !envelope.at_rest(); ++ticks) envelope.step(false);
  EXPECT_LE(ticks, 101);
  EXPECT_EQ(envelope.step(false), 0);
}

TEST(DriveLimiter, NeverPassesItsLimits) {
  std::mt19937 random(6);
  std::normal_distribution<float> normal(0, 4);
  DriveLimiter limiter;
  limiter.set(5, 0.7F);
  float before_v = 0;
  for (int i = 0; i < 10000; ++i) {
    std::uint32_t flags = 0;
    const float target_v = normal(random), drive_v = limiter.limit(target_v, flags);
    ASSERT_LE(std::abs(drive_v), 5);
    ASSERT_LE(std::abs(drive_v - before_v), 0.7F * 1.000001F);
    ASSERT_EQ(flags == 0, drive_v == target_v);
    before_v = drive_v;
  }
}

TEST(SweepGenerator, ItsSineIsASine) {
  double worst = 0;
  for (std::uint64_t phase = 0; phase < 0x100000000; phase += 12345)
    worst = std::max(worst,
                     std::abs(sine_of_phase(static_cast<std::uint32_t>(phase)) -
                              std::sin(2 * std::numbers::pi * std::ldexp(static_cast<double>(phase), -32))));
  EXPECT_LT(worst, 4e-6);
}

// phase(n) = f0 / rate (g^n - 1) / (g - 1), g = 1 + growth: the closed form of the integer arithmetic.
// Tolerance: 2^-32 of the frequency per tick, rounded down, over 20000 ticks of up to 1/12 turn, and the
// sine's 4e-6.
TEST(SweepGenerator, GrowsAsItsClosedForm) {
  const double rate_hz = 10e3, growth = 188000 / 0x1p32;
  SweepGenerator sweep;
  ASSERT_TRUE(sweep.set({2, 10000, 800000, 188000}, 10'000'000));
  int ticks = 0;
  for (; !sweep.done(); ++ticks) {
    const double turns = 10 / rate_hz * std::expm1(ticks * std::log1p(growth)) / growth;
    ASSERT_NEAR(sweep.next(), 2 * std::sin(2 * std::numbers::pi * turns), 2e-4) << ticks;
  }
  EXPECT_NEAR(ticks, std::log(80) / std::log1p(growth), 2);
  EXPECT_EQ(sweep.next(), 0);
}

TEST(SweepGenerator, RefusesWhatIsNoSweep) {
  SweepGenerator sweep;
  EXPECT_FALSE(sweep.set({1, 0, 1000, 1}, 10'000'000));
  EXPECT_FALSE(sweep.set({1, 2000, 1000, 1}, 10'000'000));
  EXPECT_FALSE(sweep.set({1, 1000, 5'000'000, 1}, 10'000'000));
  EXPECT_FALSE(sweep.set({1, 1000, 2000, 0}, 10'000'000));
}

}  // namespace
}  // namespace tacto::core
