// SPDX-License-Identifier: GPL-3.0-or-later
// Fidelity on the emulated device: as good as the kernel if the tray is the model, worse by each effect
// beyond the model, with the losses by the limits reported.
#include "analysis/fidelity/fidelity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/fidelity/fidelity_page.hpp"
#include "spatial/features/band_kept.hpp"
#include "tests/analysis/compare_textures.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::analysis {
namespace {

class FidelityOfATexture : public testing::Test {
 protected:
  // 0.3 to 6 /mm: 15 to 310 Hz at 51.7 mm/s, a speed with a fractional number of counts per tick.
  void SetUp() override {
    const RandomSurface surface(4, 300, 6000, 100);
    ASSERT_TRUE(schema::write_texture(folder_ / "made",
                                      made_texture(5e-6, 8000, [&](double x) { return 3e-3 * surface(x); })));
    options_.play.program.file = folder_ / "made";
    options_.play.device_uri = "sim:seed=4711";
    options_.play.prepare.onset_s = 0.02;
    options_.speeds_mps = {51.7e-3};
  }
  Fidelity measured() {
    auto found = fidelity(options_);
    EXPECT_TRUE(found) << schema::message(found.error());
    return found ? std::move(*found) : Fidelity{};
  }
  static const FidelityRow& row(const Fidelity& fidelity, const std::string& tray) {
    for (const FidelityRow& each : fidelity.speeds.at(0).rows)
      if (each.tray.starts_with(tray)) return each;
    throw std::out_of_range(tray);
  }

  tests::TemporaryFolder folder_;
  FidelityOptions options_;
};

// Reference: playback's table (tests/playback/fidelity_table.py, row b at its median speed): -61 dB; other
// textures and the ends of a short one may cost 7 dB.
TEST_F(FidelityOfATexture, RowsAreInTheOrderOfWhatTheTrayHasBesideTheModel) {
  const Fidelity found = measured();
  ASSERT_EQ(found.speeds.size(), 1U);
  EXPECT_FALSE(found.simulated.empty());
  const double ideal_db = row(found, "ideal").error_db;
  EXPECT_LT(ideal_db, -54);
  EXPECT_GT(ideal_db, -75);
  EXPECT_NEAR(row(found, "ideal").level_db, 0, 0.01);
  // The sensor's low-pass of 5 kHz removes 0.5 % at 500 Hz: -46 dB at most, which is negligible beside -11
  // dB.
  EXPECT_GT(*row(found, "ideal").rerecorded_db, ideal_db);
  EXPECT_LT(*row(found, "ideal").rerecorded_db, -46);
  EXPECT_NEAR(*row(found, "all").rerecorded_db, row(found, "all").error_db, 0.5);
  EXPECT_NE(*row(found, "all").rerecorded_db, row(found, "all").error_db);
  EXPECT_GT(row(found, "mode").error_db, ideal_db + 10);
  EXPECT_GT(row(found, "finger").error_db, ideal_db + 10);
  EXPECT_GT(row(found, "hysteresis").error_db, ideal_db + 30);
  EXPECT_GT(row(found, "all").error_db, ideal_db + 30);
  // A small swing has a gain of 1 - 2 x 0.16, within 1/32 (BenderHysteresis): -3.3 dB; a larger swing has a
  // larger gain.
  EXPECT_GT(row(found, "hysteresis").level_db, -3.5);
  EXPECT_LT(row(found, "hysteresis").level_db, -1);
  const FidelitySpeed& speed = found.speeds.front();
  EXPECT_EQ(speed.amplitude_limited + speed.slew_limited, 0U);
  EXPECT_LT(*speed.removed_db, -200);
  EXPECT_GT(speed.band_kept_percent, 97);
}

TEST_F(FidelityOfATexture, TellsWhatTheLimitsTookAway) {
  options_.play.device_uri = "sim:seed=4711,hysteresis=0.1";
  options_.play.program.gain = {0.05, false};  // 150 um RMS: beyond the transducer's 5 V
  const Fidelity found = measured();
  ASSERT_EQ(found.speeds.front().rows.size(), 1U) << "the URI says which tray it is";
  EXPECT_GT(found.speeds.front().amplitude_limited, 100U);
  EXPECT_GT(*found.speeds.front().removed_db, -20);
  EXPECT_NEAR(found.speeds.front().drive_peak_v, found.speeds.front().drive_limit_v, 1e-3);
  EXPECT_GT(found.speeds.front().rows.front().error_db, -12);
}

// 3 mm RMS of 100 um, and 150 um RMS of them.
TEST_F(FidelityOfATexture, AsksAboutTheUnitAtThirtyTimesTheLimit) {
  options_.play.device_uri = "sim:seed=4711,hysteresis=0.1";
  for (const double gain_m_per_n : {1.0, 0.05}) {
    options_.play.program.gain = {gain_m_per_n, false};
    std::string notes;
    const Fidelity found = measured();
    for (const std::string& note : found.speeds.front().notes) notes += note;
    EXPECT_EQ(notes.find("check the texture's unit") != std::string::npos, gain_m_per_n == 1.0) << notes;
  }
}

TEST_F(FidelityOfATexture, TheBandTakesWhatIsTooFast) {
  options_.play.device_uri = "sim:seed=4711,hysteresis=0.1";
  options_.speeds_mps = {0.2};  // 6 /mm at 1.2 kHz: 500 Hz is 2.5 /mm
  const Fidelity found = measured();
  EXPECT_NEAR(found.speeds.front().band_kept_percent, 100 * (2500.0 - 300) / (6000 - 300), 4)
      << "of an even spectrum";
}

// Parts outside of the valid band are played, too, and count.
TEST_F(FidelityOfATexture, TheBandIsToldOfAllThatIsPlayed) {
  options_.play.device_uri = "sim:seed=4711,hysteresis=0.1";
  options_.speeds_mps = {0.2};
  schema::Texture texture = schema::read_texture(folder_ / "made").value();
  texture.valid_band = {{0, 2000, 6000}, {0.04, 2000, 6000}};
  ASSERT_TRUE(schema::write_texture(folder_ / "half-known", texture));
  options_.play.program.file = folder_ / "half-known";
  const Fidelity found = measured();
  ASSERT_EQ(found.speeds.size(), 1U);
  EXPECT_NEAR(found.speeds.front().band_kept_percent, 100 * (2500.0 - 300) / (6000 - 300), 4);
}

// At 50 mm/s 15-500 Hz are 300-10000 /m. With 40 mm a transform resolves lines 25 /m apart, and a window of a
// quarter of it 100 /m; still, lines half a bin beside an edge must be inside or outside.
TEST(BandKept, CountsALineBesideAnEdgeAsAWhole) {
  const auto kept = [](double line_per_m, double beside_per_m) {
    const auto texture = made_texture(5e-6, 8000, [&](double x) {
      return std::sin(2 * std::numbers::pi * line_per_m * x + 1) +
             std::sin(2 * std::numbers::pi * beside_per_m * x);
    });
    return spatial::band_kept_percent(texture, 50e-3, {15, 500});
  };
  constexpr double kWithin_per_m = 3000, kBeyond_per_m = 20e3;
  // Hann's sidelobes of the other line, 100 bins away, and of a line's own negative frequency: far less than
  // 1 %.
  for (const double out_per_m : {180.0, 250.0, 290.0, 297.0, 10'003.0, 10'010.0}) {
    EXPECT_NEAR(kept(out_per_m, kBeyond_per_m), 0, 0.5) << out_per_m;
    EXPECT_NEAR(kept(out_per_m, kWithin_per_m), 50, 0.5) << out_per_m;
  }
  for (const double in_per_m : {303.0, 310.0, 350.0, 9'990.0, 9'997.0})
    EXPECT_NEAR(kept(in_per_m, kWithin_per_m), 100, 0.5) << in_per_m;
}

// The share is one of power, along a texture whose amplitude grows: at each place 1 in the band to 4 outside.
TEST(BandKept, IsAShareOfThePowerWhereLinesGrow) {
  const auto texture = made_texture(5e-6, 8000, [](double x) {
    const auto line = [x](double per_m) { return std::sin(2 * std::numbers::pi * per_m * x); };
    return (1 + 20 * x) * (line(1000) + 2 * line(15e3));
  });
  EXPECT_NEAR(spatial::band_kept_percent(texture, 50e-3, {15, 500}), 20, 0.2);
}

TEST_F(FidelityOfATexture, PageSaysSimulatedAtEveryFigure) {
  const Fidelity found = measured();
  const auto page = fidelity_page(found);
  ASSERT_TRUE(page) << schema::message(page.error());
  std::size_t said = 0;
  for (auto at = page->find(">simulated</td>"); at != page->npos; at = page->find(">simulated</td>", at + 1))
    ++said;
  EXPECT_EQ(said, found.speeds.front().rows.size());
  for (const auto& figure : fidelity_figures(found))
    EXPECT_TRUE(figure.value.find("simulated") != figure.value.npos ||
                figure.name.find("removed") != figure.name.npos);
  EXPECT_EQ(page->find("http"), page->npos);
}

TEST_F(FidelityOfATexture, RefusesWhatCannotBePlayed) {
  const auto fault = [&] {
    const auto found = fidelity(options_);
    EXPECT_FALSE(found);
    return found ? schema::ErrorKind::internal : found.error().kind;
  };
  options_.speeds_mps = {-0.05};
  EXPECT_EQ(fault(), schema::ErrorKind::usage);
  options_.speeds_mps = {};
  EXPECT_EQ(fault(), schema::ErrorKind::usage);
  options_.speeds_mps = {0.45};
  EXPECT_EQ(fault(), schema::ErrorKind::unsuitable) << "40 mm pass before the tray has settled";
  options_.speeds_mps = {0.05, 1e-6};
  const auto endless = fidelity(options_);
  ASSERT_FALSE(endless);
  EXPECT_EQ(endless.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_NE(endless.error().what.find("4e+04 s"), std::string::npos) << endless.error().what;
  // 39.995 mm in 500 s (1e7 samples at 20 kHz) less 2 s; a thousandth more for rounding.
  EXPECT_NE(endless.error().remedy.find("80.39 um/s"), std::string::npos) << endless.error().remedy;
  options_.speeds_mps = {0.05};
  options_.play.device_uri = "sim:nonsense=1";
  EXPECT_EQ(fault(), schema::ErrorKind::usage);
  options_.play.device_uri = "sim:";
  options_.play.program.file = folder_ / "absent";
  EXPECT_EQ(fault(), schema::ErrorKind::not_found);
}

}  // namespace
}  // namespace tacto::analysis
