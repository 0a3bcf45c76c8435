// SPDX-License-Identifier: GPL-3.0-or-later
// Drives beyond the transducer's limits: refused by name and number, or clipped and counted.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>

#include "made_textures.hpp"
#include "playback/render/render.hpp"
#include "rayleigh_law.hpp"

namespace tacto::playback {
namespace {

class RenderLimits : public testing::Test {
 protected:
  schema::Texture texture_ = sine_texture(0.12, 4e3, 0.02);
  FingerPath path_ = there_and_back(0.01, 0.08, 2);
  schema::Transducer transducer_ = *schema::read_transducer("wiertlewski2011");
  RenderOptions options_;

  schema::Result<Rendering> rendered() const { return render(texture_, path_, transducer_, options_); }

  // Sets each limit to half of what an unlimited drive uses.
  void halve(double schema::Transducer::*limit, const Peak& peak) { transducer_.*limit = peak.value / 2; }
};

double gain_named_in(const std::string& remedy) {
  std::smatch found;
  EXPECT_TRUE(std::regex_search(remedy, found, std::regex("fits is ([0-9.e+-]+)mm/N"))) << remedy;
  return std::stod(found[1]) * 1e-3;
}

TEST_F(RenderLimits, TheGainThatIsNamedFitsAndIsTheLargest) {
  const Peaks free = rendered()->peaks;
  for (auto [limit, peak] : {std::pair{&schema::Transducer::drive_limit_v, free.drive_v},
                             std::pair{&schema::Transducer::slew_limit_v_per_s, free.slew_v_per_s},
                             std::pair{&schema::Transducer::displacement_limit_m, free.displacement_m}}) {
    transducer_ = *schema::read_transducer("wiertlewski2011");
    options_ = {};
    halve(limit, peak);
    const auto refused = rendered();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, schema::ErrorKind::unsuitable);
    EXPECT_NE(refused.error().what.find(peak.name), std::string::npos) << refused.error().what;
    options_.gain_m_per_n = gain_named_in(refused.error().remedy);
    EXPECT_NEAR(options_.gain_m_per_n, 0.5e-3, 1e-6);
    EXPECT_TRUE(rendered());
    options_.gain_m_per_n *= 1.002;
    EXPECT_FALSE(rendered());
  }
}

TEST_F(RenderLimits, ClippingHoldsEachLimitAndSaysWhatItTook) {
  const auto free = rendered();
  ASSERT_TRUE(free);
  EXPECT_FALSE(free->clipping);
  options_.over_limit = OverLimit::clip;
  halve(&schema::Transducer::drive_limit_v, free->peaks.drive_v);
  const auto clipped = rendered();
  ASSERT_TRUE(clipped) << message(clipped.error());
  ASSERT_TRUE(clipped->clipping);
  EXPECT_LE(clipped->peaks.drive_v.used(), 1 + 1e-6);
  EXPECT_NEAR(clipped->clipping->peak_reduced_db, 6.02, 0.01);
  EXPECT_GT(clipped->clipping->samples, 100U);
  EXPECT_LT(clipped->clipping->removed_db, 0);
  EXPECT_GT(clipped->clipping->removed_db, -60);
  EXPECT_GT(clipped->error_db, free->error_db + 20);
}

TEST_F(RenderLimits, ClippedDisplacementAndSlewFitToo) {
  const Peaks free = rendered()->peaks;
  options_.over_limit = OverLimit::clip;
  halve(&schema::Transducer::displacement_limit_m, free.displacement_m);
  halve(&schema::Transducer::slew_limit_v_per_s, free.slew_v_per_s);
  const auto clipped = rendered();
  ASSERT_TRUE(clipped) << message(clipped.error());
  EXPECT_LE(clipped->peaks.displacement_m.used(), 1);
  // 1e-5: a step of two neighbours that were each rounded to float.
  EXPECT_LE(clipped->peaks.slew_v_per_s.used(), 1 + 1e-5);
}

// The kernel's limits are reported as the reference's are; so is the displacement limit, which the kernel
// does not enforce.
TEST_F(RenderLimits, TheKernelNamesItsLimitAndTheGainThatFits) {
  options_.engine = Engine::kernel;
  const Peaks free = rendered()->peaks;
  for (auto [limit, peak] : {std::pair{&schema::Transducer::drive_limit_v, free.drive_v},
                             std::pair{&schema::Transducer::slew_limit_v_per_s, free.slew_v_per_s},
                             std::pair{&schema::Transducer::displacement_limit_m, free.displacement_m}}) {
    transducer_ = *schema::read_transducer("wiertlewski2011");
    options_.gain_m_per_n = 1e-3;
    halve(limit, peak);
    const auto refused = rendered();
    ASSERT_FALSE(refused);
    const std::string said = message(refused.error());
    EXPECT_NE(said.find(fmt::format("the {} reaches {:.4g} {}, its limit is {:.4g}", peak.name, peak.value,
                                    peak.unit, peak.value / 2)),
              std::string::npos)
        << said;
    EXPECT_NE(said.find(fmt::format("{:.4f} s after", peak.time_s)), std::string::npos) << said;
    options_.gain_m_per_n = gain_named_in(refused.error().remedy);
    EXPECT_NEAR(options_.gain_m_per_n, 0.5e-3, 1e-6);
    EXPECT_TRUE(rendered());
    options_.gain_m_per_n *= 1.002;
    EXPECT_FALSE(rendered());
  }
}

// An energy limit and an inverted hysteresis are not proportional to the gain: a proportional estimate would
// be too large.
TEST_F(RenderLimits, TheKernelsGainFitsWhereNothingIsProportional) {
  options_.engine = Engine::kernel;
  for (const bool energy : {true, false}) {
    transducer_ = *schema::read_transducer("wiertlewski2011");
    if (!energy) transducer_.hysteresis = rayleigh(0.16, transducer_.drive_limit_v, 12);
    options_.gain_m_per_n = 1e-3;
    options_.energy_rms_v = 0;
    const Peak free = rendered()->peaks.drive_v;
    transducer_.drive_limit_v = free.value / 3;
    if (energy) options_.energy_rms_v = free.value / 4;
    const auto refused = rendered();
    ASSERT_FALSE(refused);
    options_.gain_m_per_n = gain_named_in(refused.error().remedy);
    EXPECT_TRUE(rendered()) << energy;
  }
}

// At some starting positions the drive rose by more than its slew limit, for 5 ms.
TEST_F(RenderLimits, WhatFitsTheReferenceFitsTheKernelWhereverTheFingerStarts) {
  texture_ = texture_of(0.12, [](double x) { return 0.02 * std::cos(kTwoPi * 1e3 * x); });
  path_ = steady_path(0.01, 0.05, 2);
  const Peaks free = rendered()->peaks;
  transducer_.slew_limit_v_per_s = 1.5 * free.slew_v_per_s.value;
  ASSERT_TRUE(rendered());
  options_.engine = Engine::kernel;
  const auto kernel = rendered();
  ASSERT_TRUE(kernel) << message(kernel.error());
  EXPECT_EQ(kernel->onset_s, schema::kOnsetS);
  EXPECT_FALSE(kernel->removed_db);
  options_.onset_s = 0;
  EXPECT_FALSE(rendered());
}

// At 1.1 kHz a 450 Hz drive has its samples far from its peaks: the peak between them decides.
TEST_F(RenderLimits, PeaksBetweenSamplesCount) {
  path_ = steady_path(0.005, 0.1125, 0.8);
  const auto fine = rendered();
  options_.rate_hz = 1100;
  const auto coarse = rendered();
  ASSERT_TRUE(fine && coarse);
  EXPECT_NEAR(coarse->peaks.drive_v.value, fine->peaks.drive_v.value, 0.03 * fine->peaks.drive_v.value);
}

}  // namespace
}  // namespace tacto::playback
