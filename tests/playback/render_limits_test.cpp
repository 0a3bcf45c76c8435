// SPDX-License-Identifier: GPL-3.0-or-later
// Drives beyond the transducer's limits: refused by name and number, or clipped and counted.
#include <gtest/gtest.h>

#include <regex>

#include "made_textures.hpp"
#include "playback/render.hpp"

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
    EXPECT_EQ(refused.error().fault, schema::Fault::unsuitable);
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
