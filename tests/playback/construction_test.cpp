// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that are not named are not built, by the counters of their builders.
#include <gtest/gtest.h>

#include <algorithm>

#include "data-schema/scene/scene.hpp"
#include "playback/player/program.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/playback/made_textures.hpp"
#include "tests/playback/rayleigh_law.hpp"

namespace tacto::playback {
namespace {

schema::Transducer built_transducer(bool hysteresis = false) {
  schema::Transducer transducer = *schema::read_transducer("wiertlewski2011");
  if (hysteresis) transducer.hysteresis = rayleigh(0.16, 5, 16);
  return transducer;
}

Prepared built_with(const std::function<void(PrepareOptions&)>& change, bool hysteresis = false) {
  PrepareOptions options;
  change(options);
  const auto prepared = prepare(sine_texture(0.02, 3000, 0.02), built_transducer(hysteresis), options);
  EXPECT_TRUE(prepared) << message(prepared.error());
  return prepared ? *prepared : Prepared{};
}

bool leaves_out(const Prepared& prepared, const std::string& what) {
  return std::ranges::any_of(left_out_of(prepared),
                             [&](const LeftOut& each) { return each.part.find(what) != std::string::npos; });
}

TEST(Construction, WhatNobodyNamesIsNotBuilt) {
  const Prepared plain = built_with([](PrepareOptions&) {});
  const ConstructionTally& built = plain.built;
  EXPECT_EQ(built.seams, 0U);
  EXPECT_EQ(built.hysteresis, 0U);
  EXPECT_EQ(built.play_operators, 0U);
  EXPECT_EQ(built.sections, 0U);
  EXPECT_EQ(built.energy_limits, 0U);
  EXPECT_EQ(built.touch_gates, 0U);
  for (const char* what : {"loop's seam", "hysteresis", "sections", "energy limit", "touch gate", "levels"})
    EXPECT_TRUE(leaves_out(plain, what)) << what;
  EXPECT_FALSE(leaves_out(plain, "a filter that inverts"));
}

// The counters are correct: each part has the size that its counter states.
TEST(Construction, WhatIsThereIsCounted) {
  const Prepared plain = built_with([](PrepareOptions&) {});
  EXPECT_EQ(plain.built.textures_placed, 1U);
  EXPECT_EQ(plain.built.levels, plain.scale.levels);
  EXPECT_EQ(plain.built.sample_bytes, sizeof(float) * core::pyramid_samples(plain.scale));
  EXPECT_EQ(plain.built.sample_bytes, sizeof(float) * plain.samples.size());
  EXPECT_EQ(plain.built.filters, 1U);
  EXPECT_EQ(plain.built.taps, plain.taps.size());
  EXPECT_EQ(plain.built.following, 2U);
}

TEST(Construction, EachThingThatIsNamedHasItsCount) {
  EXPECT_EQ(built_with([](PrepareOptions& o) { o.energy_rms_v = 1; }).built.energy_limits, 1U);
  EXPECT_EQ(built_with([](PrepareOptions& o) { o.contact_on_n = 0.2; }).built.touch_gates, 1U);
  EXPECT_EQ(built_with([](PrepareOptions& o) { o.ends = Ends::loop; }).built.seams, 1U);
  EXPECT_EQ(built_with([](PrepareOptions& o) { o.ends = Ends::loop, o.seam_m = 0; }).built.seams, 0U);
  const Prepared undone = built_with([](PrepareOptions&) {}, true);
  EXPECT_EQ(undone.built.hysteresis, 1U);
  EXPECT_EQ(undone.built.play_operators, 16U);
  EXPECT_EQ(undone.built.sections, 1U);
  EXPECT_FALSE(leaves_out(undone, "play operators that invert"));
}

TEST(Construction, WhatIsTurnedOffIsNotBuilt) {
  const Prepared kept = built_with([](PrepareOptions& o) { o.undo_hysteresis = false; }, true);
  EXPECT_EQ(kept.built.hysteresis + kept.built.play_operators + kept.built.sections, 0U);
  const Prepared gain = built_with([](PrepareOptions& o) { o.inverse = Inverse::gain; });
  EXPECT_EQ(gain.built.filters, 0U);
  EXPECT_EQ(gain.built.taps, 1U);
  const Prepared still = built_with([](PrepareOptions& o) { o.look_ahead = o.between_counts = false; });
  EXPECT_EQ(still.built.following, 0U);
}

// A slow finger needs no coarse levels, a smooth texture no fine ones.
TEST(Construction, LevelsAreThoseThatSpeedAndTextureAskFor) {
  const auto levels = [](double speed_mps) {
    return built_with([=](PrepareOptions& o) { o.max_speed_mps = speed_mps; }).built.levels;
  };
  EXPECT_EQ(levels(0.05), 1U);
  EXPECT_LT(levels(0.2), levels(0.5));
}

class BuiltScenes : public testing::Test {
 protected:
  ConstructionTally built(std::vector<schema::Layer> layers) {
    schema::Scene scene;
    scene.layers = std::move(layers);
    EXPECT_TRUE(schema::write_scene(folder_ / "bench", scene));
    const auto program = make_program({folder_ / "bench.scene.json", {}, {}, {}}, "wiertlewski2011", {});
    EXPECT_TRUE(program) << message(program.error());
    return program ? program->prepared.built : ConstructionTally{};
  }
  static schema::TextureLayer layer(const std::string& name, double at_m) {
    return {name, at_m, 1e-3, "", "", {}, ""};
  }
  void SetUp() override {
    ASSERT_TRUE(schema::write_texture(folder_ / "oak", sine_texture(0.01, 1000, 0.02)));
    ASSERT_TRUE(schema::write_texture(folder_ / "cork", sine_texture(0.01, 1700, 0.01)));
  }
  tests::TemporaryFolder folder_;
};

TEST_F(BuiltScenes, AFileIsReadOnceHoweverOftenItLies) {
  const ConstructionTally twice = built({layer("oak", 0), layer("oak", 0.03)});
  EXPECT_EQ(twice.texture_files, 1U);
  EXPECT_EQ(twice.textures_placed, 2U);
  const ConstructionTally both =
      built({layer("oak", 0), layer("cork", 0.03), layer("oak.texture.json", 0.06)});
  EXPECT_EQ(both.texture_files, 2U);
  EXPECT_EQ(both.textures_placed, 3U);
}

}  // namespace
}  // namespace tacto::playback
