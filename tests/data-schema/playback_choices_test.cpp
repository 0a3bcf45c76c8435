// SPDX-License-Identifier: GPL-3.0-or-later
// The object `playback` is the same in scene, configuration and request.
#include "data-schema/scene/playback_choices.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "data-schema/control/control.hpp"
#include "data-schema/control/daemon_config.hpp"
#include "data-schema/scene/scene.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

constexpr const char* kAll =
    R"({"interpolation":"sinc","inverse":"none","reconstruction":"butterworth3","cutoff_hz":550,"hold":"none",)"
    R"("energy_rms_v":2.5,"energy_window_s":0.5,"contact_on_n":0.3,"contact_off_n":0.2})";

void expect_all(const PlaybackChoices& choices) {
  EXPECT_EQ(choices.interpolation, "sinc");
  EXPECT_EQ(choices.inverse, "none");
  EXPECT_EQ(choices.reconstruction, "butterworth3");
  EXPECT_EQ(choices.cutoff_hz, 550);
  EXPECT_EQ(choices.hold, "none");
  EXPECT_EQ(choices.energy_rms_v, 2.5);
  EXPECT_EQ(choices.energy_window_s, 0.5);
  EXPECT_EQ(choices.contact_on_n, 0.3);
  EXPECT_EQ(choices.contact_off_n, 0.2);
}

std::string scene_with(const std::string& playback, const std::string& version = "1.0") {
  return R"({"kind":"scene","version":")" + version + R"(","playback":)" + playback +
         R"(,"layers":[{"type":"texture","texture":"oak","at_m":0,"gain_m_per_n":0.001}]})";
}

TEST(PlaybackChoices, ASceneKeepsThemAndWhatIsNewer) {
  const auto scene = parse_scene(scene_with(kAll), "s");
  ASSERT_TRUE(scene) << message(scene.error());
  expect_all(scene->playback);
  tests::TemporaryFolder folder;
  auto newer = parse_scene(scene_with(R"({"inverse":"gain","friction":"none"})", "1.4"), "s");
  ASSERT_TRUE(newer) << message(newer.error());
  ASSERT_TRUE(write_scene(folder / "s", *newer));
  const auto again = read_scene(folder / "s");
  ASSERT_TRUE(again) << message(again.error());
  EXPECT_EQ(again->playback.inverse, "gain");
  EXPECT_EQ(again->playback.extra_json, R"({"friction":"none"})");
}

TEST(PlaybackChoices, ARequestKeepsThem) {
  const auto request =
      parse_control_request(R"({"request":"load","file":"oak","playback":)" + std::string(kAll) + "}");
  ASSERT_TRUE(request) << message(request.error());
  expect_all(request->playback);
  const auto again = parse_control_request(control_request_line(*request));
  ASSERT_TRUE(again);
  expect_all(again->playback);
}

TEST(ControlRequest, AMisspeltRequestGetsTheNearest) {
  const auto request = parse_control_request(R"({"request":"lod","file":"oak"})");
  ASSERT_FALSE(request);
  EXPECT_NE(request.error().what.find("'load'"), std::string::npos) << message(request.error());
}

TEST(PlaybackChoices, AConfigurationTakesThemAndNothingElse) {
  tests::TemporaryFolder folder;
  const auto config_of =
      [&](const std::string& playback) {
        std::ofstream(folder / "d.json")
            << R"({"kind":"daemon","version":"1.0","device":"sim:","transducer":"t",)"
            << R"("socket":"s","sessions":"f","playback":)" << playback << "}";
        return read_daemon_config(folder / "d.json");
      };
  const auto config = config_of(kAll);
  ASSERT_TRUE(config) << message(config.error());
  expect_all(config->playback);
  EXPECT_FALSE(config_of(R"({"friction":1})"));
}

TEST(PlaybackChoices, WhatIsMisspeltIsNamed) {
  const std::string request = R"({"request":"load","file":"oak",)";
  const auto wrong = parse_control_request(request + R"("playback":{"interpolaton":"sinc"}})");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().what.find("'interpolaton'"), std::string::npos) << message(wrong.error());
  EXPECT_EQ(wrong.error().where, "request#/playback/interpolaton");
  EXPECT_EQ(wrong.error().remedy, "did you mean 'interpolation'?");
}

TEST(PlaybackChoices, WrongOnesAreNamedByJsonPointer) {
  for (const auto& [playback, where] :
       {std::pair{R"({"interpolation":"cubic"})", "s#/playback/interpolation"},
        std::pair{R"({"contact_on_n":-1})", "s#/playback/contact_on_n"},
        std::pair{R"({"energy_window_s":0})", "s#/playback/energy_window_s"}}) {
    const auto scene = parse_scene(scene_with(playback), "s");
    ASSERT_FALSE(scene) << playback;
    EXPECT_EQ(scene.error().where, where) << message(scene.error());
  }
  const auto request =
      parse_control_request(R"({"request":"load","file":"a","playback":{"contact_on_n":-1}})");
  ASSERT_FALSE(request);
  EXPECT_NE(message(request.error()).find("from 0 to 100"), std::string::npos) << message(request.error());
}

}  // namespace
}  // namespace tacto::schema
