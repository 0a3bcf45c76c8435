// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel under a finger: passed content, aliasing, changes. Against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <random>

#include "made_textures.hpp"
#include "playback/model/limit_tally.hpp"
#include "playback/prepare/prepare.hpp"
#include "tests/measured.hpp"

namespace tacto::playback {
namespace {

constexpr double kTrueCountM = 2e-9;  // so fine that the count is the exact position

schema::Transducer kernel_transducer() {
  return *schema::read_transducer("wiertlewski2011");
}

double level_of(double ratio) {
  return 20 * std::log10(ratio);
}

/// Without the transducer: the target, m at 1 m/N.
PrepareOptions plain_options(double rate_hz, Ends ends = Ends::loop) {
  PrepareOptions options;
  options.rate_hz = rate_hz;
  options.metres_per_count = kTrueCountM;
  options.gain_m_per_n = 1;
  options.ends = ends;
  options.seam_m = 0;
  options.inverse = Inverse::gain;
  options.look_ahead = false;
  return options;
}

/// A loop of 10 mm.
schema::Texture looped(const std::function<double(double)>& force_n) {
  auto texture = texture_of(0.01, force_n);
  texture.signal.values.pop_back();
  return texture;
}

schema::Texture tone_loop(double per_m) {
  return looped([=](double x) { return std::sin(kTwoPi * per_m * x); });
}

std::int32_t count_at(double position_m, const PrepareOptions& o) {
  return static_cast<std::int32_t>(std::floor(position_m / o.metres_per_count));
}

/// The texture's values along a path, without the first tenth of a second.
std::vector<double> target_along(const Prepared& prepared, const PrepareOptions& o, double duration_s,
                                 const std::function<double(double)>& position_m) {
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(duration_s * o.rate_hz); ++i) {
    const double value = kernel.target(count_at(position_m(i / o.rate_hz), o), 1);
    if (i >= 0.1 * o.rate_hz) values.push_back(value);
  }
  return values;
}

double rms_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

class AtRate : public testing::TestWithParam<double> {};

std::string rate_key(double rate_hz) {
  return std::to_string(std::lround(1e-3 * rate_hz)) + "khz_db";
}

// The texture has only a tone that would alias into 15-500 Hz, so that all output is its residual. -60 dB.
TEST_P(AtRate, NothingFoldsIntoTheBandAtAnySpeed) {
  const PrepareOptions options = plain_options(GetParam());
  double worst = 0;
  for (const double speed_mps : {0.031, 0.0703, 0.1, 0.233, 0.354, 0.5})
    for (int harmonic = 1; harmonic <= 4; ++harmonic)
      for (const double beside_hz : {-498.0, -250.0, -20.0, 20.0, 250.0, 498.0}) {
        const double per_m = 100 * std::round((harmonic * GetParam() + beside_hz) / speed_mps / 100);
        if (per_m > 150e3) continue;
        const auto prepared = prepare(tone_loop(per_m), kernel_transducer(), options);
        ASSERT_TRUE(prepared) << message(prepared.error());
        const auto values =
            target_along(*prepared, options, 0.4, [&](double t) { return 0.01 + speed_mps * t; });
        worst = std::max(worst, rms_of(values) * std::numbers::sqrt2);
      }
  measured("texture_kernel.one_tone_" + rate_key(GetParam()), level_of(worst));
  EXPECT_LT(level_of(worst), -60);
}

// Many tones, coarse and fine, at once: content of the band passes unchanged, other content has no effect.
TEST_P(AtRate, TheWholeBandComesAsTheReferenceHasIt) {
  const PrepareOptions options = plain_options(GetParam());
  std::mt19937 random(5);
  std::vector<std::pair<double, double>> tones;  // spatial frequency, phase
  for (double per_m = 100; per_m < 140e3; per_m = 100 * std::ceil(per_m * 1.07 / 100))
    tones.emplace_back(per_m, std::uniform_real_distribution<>(0, kTwoPi)(random));
  const auto sum_of = [&](double x, double most_per_m) {
    double sum = 0;
    for (const auto& [per_m, phase] : tones)
      if (per_m <= most_per_m) sum += std::sin(kTwoPi * per_m * x + phase);
    return sum;
  };
  const auto texture = looped([&](double x) { return sum_of(x, 1e9); });
  const auto prepared = prepare(texture, kernel_transducer(), options);
  ASSERT_TRUE(prepared);
  const double size = std::sqrt(static_cast<double>(tones.size()) / 2);
  double worst_db = -1e9;
  for (const double speed_mps : {0.013, 0.05, 0.11, 0.27, 0.5}) {
    const auto path = [&](double t) { return 0.01 + speed_mps * t; };
    const auto values = target_along(*prepared, options, 1.1, path);
    std::vector<double> error;
    const auto skipped = static_cast<std::size_t>(0.1 * options.rate_hz);
    for (std::size_t i = 0; i < values.size(); ++i)
      error.push_back(values[i] -
                      sum_of(path(static_cast<double>(i + skipped) / options.rate_hz), 505 / speed_mps));
    // Bins of the band, at a distance of Hann's width from content beyond it. The reference extends slightly
    // beyond the band, as levels do.
    double in_band = 0;
    for (int f = 16; f < 496; ++f) {
      std::complex<double> bin = 0;
      for (std::size_t i = 0; i < error.size(); ++i)
        bin += error[i] * std::polar(1.0, -kTwoPi * f * static_cast<double>(i) / options.rate_hz) *
               (1 - std::cos(kTwoPi * static_cast<double>(i) / static_cast<double>(error.size())));
      in_band += 2 * std::norm(bin) / 1.5 / std::pow(static_cast<double>(error.size()), 2);
    }
    const double error_db = level_of(std::sqrt(in_band) / size);
    EXPECT_LT(error_db, -60) << speed_mps;
    worst_db = std::max(worst_db, error_db);
  }
  measured("texture_kernel.many_tones_" + rate_key(GetParam()), worst_db);
}

INSTANTIATE_TEST_SUITE_P(Rates, AtRate, testing::Values(2e3, 5e3, 20e3));

TEST(TextureKernel, BelowTwoKilohertzTheBandShrinksAndSaysTo) {
  const auto prepared = prepare(tone_loop(5e3), kernel_transducer(), plain_options(1e3));
  ASSERT_TRUE(prepared);
  EXPECT_NEAR(prepared->passes_to_hz, 1e3 / 3.5, 1e-9);
  ASSERT_EQ(prepared->notes.size(), 1U);
  EXPECT_NE(prepared->notes[0].find("285.7 Hz"), std::string::npos) << prepared->notes[0];
}

// From 0 to 500 mm/s and back, through all levels: a tone of 100 Hz at the largest speed agrees with the
// closed form all the time (to 1e-3, because levels have the same content within the band), without a step.
TEST(TextureKernel, LevelsChangeWithoutAStep) {
  const PrepareOptions options = plain_options(2e3);
  const auto texture =
      looped([](double x) { return std::sin(kTwoPi * 200 * x) + 1e-4 * std::sin(kTwoPi * 90e3 * x); });
  const auto prepared = prepare(texture, kernel_transducer(), options);
  ASSERT_TRUE(prepared);
  EXPECT_GT(prepared->scale.levels, 10);
  const auto path = [](double t) { return 0.01 + 0.25 * (t - std::sin(kTwoPi * t / 2) * 2 / kTwoPi); };
  const auto values = target_along(*prepared, options, 2, path);
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_NEAR(values[i], std::sin(kTwoPi * 200 * path(static_cast<double>(i + 200) / 2e3)), 1e-3) << i;
}

TEST(TextureKernel, BeyondItsGreatestSpeedItFallsSilentInsteadOfFolding) {
  const PrepareOptions options = plain_options(2e3);
  const auto prepared = prepare(tone_loop(3000), kernel_transducer(), options);
  const auto values = target_along(*prepared, options, 0.3, [](double t) { return 0.01 + 1.5 * t; });
  EXPECT_LT(rms_of(values), 1e-3);
}

/// For a tone of unit amplitude with this number of samples per period.
double worst_error(wire::Interpolation kind, double period) {
  std::vector<float> samples(400);
  const double w = kTwoPi / period;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<float>(std::sin(w * static_cast<double>(i)));
  double worst = 0;
  for (int i = 100; i < 300; ++i)
    for (double u = 0; u < 1; u += 1.0 / 64)
      worst = std::max(worst, std::abs(core::interpolated(kind, samples.data() + i - core::kBefore,
                                                          static_cast<float>(u)) -
                                       std::sin(w * (i + u))));
  return worst;
}

// The errors that core/kernel/interpolation.hpp states.
TEST(Interpolation, ErrsAsStated) {
  for (const double period : {10.0, 16.0, 40.0, 100.0}) {
    const double w = kTwoPi / period;
    EXPECT_LT(worst_error(wire::Interpolation::nearest, period), 0.5 * w) << period;
    EXPECT_LT(worst_error(wire::Interpolation::linear, period), 0.125 * w * w + 4e-7) << period;
    EXPECT_LT(worst_error(wire::Interpolation::hermite, period),
              0.0026 * std::pow(w, 4) + 0.0032 * std::pow(w, 5) + 4e-7)
        << period;
  }
  double sinc = 0;
  for (const double period : {6.0, 7.3, 8.0, 10.0, 16.0, 100.0})
    sinc = std::max(sinc, worst_error(wire::Interpolation::sinc, period));
  std::printf("sinc: at most %.2e\n", sinc);
  EXPECT_LT(sinc, 6e-4);  // as stated
  EXPECT_GT(worst_error(wire::Interpolation::hermite, 6), 5e-3);
}

TEST(TextureKernel, ALoopHasNoSeam) {
  PrepareOptions options = plain_options(10e3);
  options.seam_m = 1e-3;
  const auto ramp = texture_of(0.02, [](double x) { return x / 0.02; });
  const auto prepared = prepare(ramp, kernel_transducer(), options);
  ASSERT_TRUE(prepared);
  const auto values = target_along(*prepared, options, 1.1, [](double t) { return 0.05 * t; });
  double steepest = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    steepest = std::max(steepest, std::abs(values[i] - values[i - 1]));
  EXPECT_LT(steepest, 1.7 * 5e-6 / 1e-3);  // rises over 1 mm, pi / 2 of its mean slope, at 5 um per tick
}

// The wire's rounding of a count, accumulated along the texture, relative to the shortest period; random
// densities.
TEST(TextureKernel, ACountOfAFineEncoderDoesNotDrift) {
  const auto texture = sine_texture(0.18, 8e3, 0.01);
  double worst_unaided = 0;
  for (const double step_m : {1e-6, 1e-7, 1e-8, 1e-9, 0.5e-9})
    for (const double density : {12.5, 13.1, 16.0, 23.7}) {
      PrepareOptions options = plain_options(10e3, Ends::stop);
      options.metres_per_count = step_m, options.samples_per_period = density;
      const auto prepared = prepare(texture, kernel_transducer(), options);
      ASSERT_TRUE(prepared) << message(prepared.error());
      const double exact = std::ldexp(step_m / prepared->pitch_m, 32),
                   periods = 0.18 * prepared->finest_per_m;
      const auto kept = static_cast<double>(prepared->scale.samples_per_count_q32);
      EXPECT_LT(std::abs(kept / exact - 1) * periods, 2.2e-5)
          << step_m << ", " << density;  // the margin's length
      EXPECT_LT(1 / (prepared->pitch_m * prepared->finest_per_m), 1.2 * density);
      worst_unaided = std::max(worst_unaided, 0.5 / exact * periods);
    }
  EXPECT_GT(worst_unaided, 5e-4);  // the possible effect of the rounding alone
}

TEST(TextureKernel, TwoTexturesLieWhereTheyArePlaced) {
  const auto left = texture_of(0.01, [](double) { return 1.0; }),
             right = texture_of(0.01, [](double) { return 1.0; });
  const PlacedTexture placed[] = {{&left, 0.0, 1}, {&right, 0.03, -0.5}};
  const PrepareOptions options = plain_options(2e3, Ends::stop);
  const auto prepared = prepare(placed, kernel_transducer(), options);
  ASSERT_TRUE(prepared) << message(prepared.error());
  core::TickKernel kernel;
  for (const auto& [at_m, value] :
       {std::pair{0.005, 1.0}, {0.02, 0.0}, {0.035, -0.5}, {-0.01, 0.0}, {0.06, 0.0}}) {
    kernel.set(prepared->setup());
    EXPECT_NEAR(kernel.target(count_at(at_m, options), 1), value, 1e-3) << at_m;
  }
}

/// A kernel that plays a level of 1 (V at a gain of 1) at all positions.
struct Constant {
  explicit Constant(float level, wire::Limits limits = {5, 15708, 0, 0.01F, 100, 1000}) : samples(64, level) {
    setup.texture.profile = {samples.data(), {64, 0, 0, UINT64_C(1) << 32, Ends::loop}};
    setup.limits = limits;
    setup.rate_hz = 10e3F;
  }
  std::vector<float> samples;
  core::KernelSetup setup;
};

TEST(TextureKernel, AChangeOfTextureFades) {
  Constant one(1), two(-2);
  core::TickKernel kernel;
  kernel.set(one.setup);
  float before = 0;
  for (int i = 0; i < 100; ++i) before = kernel.tick({0, 1, true, core::kNoForce}).drive_v;
  EXPECT_EQ(before, 1);
  kernel.change(two.setup.texture, 0.05F);
  for (int i = 0; i < 600; ++i) {
    const float drive_v = kernel.tick({0, 1, true, core::kNoForce}).drive_v;
    ASSERT_LT(std::abs(drive_v - before), 1.51F * 3 / 500) << i;  // 3/2 of a linear fade's slope
    before = drive_v;
  }
  EXPECT_EQ(before, -2);
  EXPECT_FALSE(kernel.changing());
}

TEST(TextureKernel, AChangeOfGainIsEven) {
  Constant one(1);
  core::TickKernel kernel;
  kernel.set(one.setup);
  for (int i = 0; i < 10; ++i) kernel.tick({0, 1, true, core::kNoForce});
  float before = 1;
  for (int i = 0; i < 101; ++i) {
    const float drive_v = kernel.tick({0, 3, true, core::kNoForce}).drive_v;
    ASSERT_LT(drive_v - before, 0.0201F);
    before = drive_v;
  }
  EXPECT_EQ(before, 3);
}

// 0.707 V RMS unlimited, 0.5 V allowed: within the 2 % that EnergyLimiter states; counted, and reported in
// dB: 20 log10(1 - 0.5 / 0.707) = -10.7 dB, less before it began.
TEST(TextureKernel, EnergyIsHeldAndCounted) {
  Constant one(1);
  one.setup.energy_rms_v = 0.5F, one.setup.energy_window_s = 0.05F;
  core::TickKernel kernel;
  kernel.set(one.setup);
  LimitTally tally;
  double late_v2 = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto unlimited_v = static_cast<float>(std::sin(kTwoPi * 200 * i / 1e4));
    const auto output = kernel.drive(unlimited_v, true, core::kNoForce);
    tally.add(output);
    if (i >= 10000) late_v2 += output.drive_v * output.drive_v;
  }
  EXPECT_NEAR(std::sqrt(late_v2 / 10000), 0.5, 0.01);
  EXPECT_GT(tally.energy_limited(), 19000U);
  EXPECT_GT(tally.removed_db(), -11.5);
  EXPECT_LT(tally.removed_db(), -10);
}

TEST(TextureKernel, WithoutTouchThereIsNoDrive) {
  Constant one(1);
  one.setup.gate_on_n = 0.2F, one.setup.gate_off_n = 0.1F;
  core::TickKernel kernel;
  kernel.set(one.setup);
  const auto after = [&](float force_n) {
    core::TickOutput output;
    for (int i = 0; i < 300; ++i) output = kernel.tick({0, 1, true, force_n});
    return output;
  };
  EXPECT_EQ(after(0.15F).drive_v, 0);
  EXPECT_EQ(after(0.15F).flags & wire::kTickGated, wire::kTickGated);
  EXPECT_EQ(after(0.25F).drive_v, 1);
  EXPECT_EQ(after(0.15F).drive_v, 1) << "between the two it stays";
  EXPECT_EQ(after(0.05F).drive_v, 0);
  EXPECT_EQ(after(core::kNoForce).drive_v, 1) << "nobody reports a force";
}

TEST(Prepare, RefusesWhatCannotBePlayed) {
  const auto texture = tone_loop(1000);
  const auto refused = [&](auto change) {
    PrepareOptions options = plain_options(2e3);
    change(options);
    const auto prepared = prepare(texture, kernel_transducer(), options);
    return prepared ? std::string() : message(prepared.error());
  };
  EXPECT_EQ(refused([](PrepareOptions&) {}), "");
  EXPECT_NE(refused([](PrepareOptions& o) { o.rate_hz = 10; }), "");
  EXPECT_NE(refused([](PrepareOptions& o) { o.metres_per_count = 0; }), "");
  EXPECT_NE(refused([](PrepareOptions& o) { o.gain_m_per_n = std::nan(""); }), "");
  EXPECT_NE(refused([](PrepareOptions& o) { o.delay_s = 1; }), "");
  EXPECT_NE(refused([](PrepareOptions& o) { o.max_speed_mps = 0; }), "");
  const std::string large = refused([](PrepareOptions& o) { o.most_samples = 50; });
  EXPECT_NE(large.find(" 50"), std::string::npos);
  EXPECT_GT(std::stod(large.substr(large.find("about ") + 6)), 0) << "how much of it fits";
  auto broken = texture;
  broken.signal.values[7] = std::nan("");
  const auto prepared = prepare(broken, kernel_transducer(), plain_options(2e3));
  ASSERT_FALSE(prepared);
  EXPECT_NE(message(prepared.error()).find("sample 7"), std::string::npos);
}

class Inverses : public testing::TestWithParam<double> {};

// The design's figures, as stated at InverseFilter; those of the tray are in playback_fidelity.
TEST_P(Inverses, AreAsGoodAndAsTameAsStated) {
  PrepareOptions options = plain_options(GetParam());
  options.inverse = Inverse::full;
  for (const auto filter : {Reconstruction::none, Reconstruction::butterworth3}) {
    options.reconstruction = filter;
    const auto prepared = prepare(tone_loop(1000), kernel_transducer(), options);
    ASSERT_TRUE(prepared);
    std::printf(
        "%5g Hz, filter %d: %zu taps, error %.1f dB, gain %.1f dB, beyond the band %.1f dB, delay %.1f ms\n",
        GetParam(), filter == Reconstruction::butterworth3, prepared->taps.size(), prepared->inverse_error_db,
        prepared->inverse_gain_db, prepared->beyond_band_db, 1e3 * prepared->delay_s);
    EXPECT_LT(prepared->inverse_error_db, filter == Reconstruction::none ? -69 : -54);
    EXPECT_LE(prepared->inverse_gain_db, 20);
    EXPECT_LT(prepared->beyond_band_db, filter == Reconstruction::none ? 2 : 8.5);
    EXPECT_LE(prepared->delay_s, 2e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, Inverses, testing::Values(2e3, 3e3, 5e3, 10e3, 20e3));

}  // namespace
}  // namespace tacto::playback
