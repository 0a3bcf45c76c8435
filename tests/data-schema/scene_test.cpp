// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/scene.hpp"

#include <gtest/gtest.h>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/texture/texture.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

TextureLayer texture_of(const Layer& layer) {
  return layer.visit([](const TextureLayer& texture) { return texture; });
}

std::string scene_text(const std::string& layer, const std::string& version = "1.0") {
  return R"({"kind":"scene","version":")" + version + R"(","layers":[)" + layer + "]}";
}

constexpr const char* kOak = R"({"type":"texture","texture":"oak","at_m":0.01,"gain_m_per_n":0.001})";

void expect_refused(const std::string& text, ErrorKind fault, const std::string& where) {
  const auto scene = parse_scene(text, "s.scene.json");
  ASSERT_FALSE(scene) << text;
  EXPECT_EQ(scene.error().kind, fault) << message(scene.error());
  EXPECT_EQ(scene.error().where, where) << message(scene.error());
}

TEST(Scene, ReadsBackWhatWasWritten) {
  tests::TemporaryFolder folder;
  Scene scene;
  scene.name = "two";
  scene.newer_version = "1.3";  // only a newer version has unknown members
  scene.layers = {TextureLayer{"oak", 0.01, 1e-3, "mw", "2026-01-02T03:04:05Z", TextureEnds::stop, ""},
                  TextureLayer{"../beech", -0.02, -5e-4, "", "", TextureEnds::stop, R"({"tint":"red"})"}};
  ASSERT_TRUE(write_scene(folder / "two", scene));
  for (const char* name : {"two", "two.scene.json", "two.scene"}) {
    const auto read = read_scene(folder / name);
    ASSERT_TRUE(read) << message(read.error());
    ASSERT_EQ(read->layers.size(), 2U);
    const TextureLayer first = texture_of(read->layers[0]);
    const TextureLayer second = texture_of(read->layers[1]);
    EXPECT_EQ(first.gain_set_by, "mw");
    EXPECT_EQ(first.ends, TextureEnds::stop);
    EXPECT_EQ(second.gain_m_per_n, -5e-4);
    EXPECT_EQ(second.extra_json, R"({"tint":"red"})");
    EXPECT_EQ(read->name, "two");
    EXPECT_EQ(read->newer_version, "1.3");
  }
}

TEST(Scene, OneTextureMayGoOnBeyondItsEnds) {
  tests::TemporaryFolder folder;
  for (const TextureEnds ends : {TextureEnds::stop, TextureEnds::mirror, TextureEnds::loop}) {
    Scene scene;
    scene.layers = {TextureLayer{"oak", 0.01, 1e-3, "", "", ends, ""}};
    ASSERT_TRUE(write_scene(folder / "one", scene));
    const auto read = read_scene(folder / "one");
    ASSERT_TRUE(read) << message(read.error());
    EXPECT_EQ(texture_of(read->layers[0]).ends, ends);
  }
}

// `validate` refuses the same scenes as `play`.
TEST(Scene, OneOfSeveralTexturesMayNotGoOnBeyondItsEnds) {
  const std::string stops = R"({"type":"texture","texture":"o","at_m":0,"gain_m_per_n":1,"ends":"stop"})";
  const std::string loops = R"({"type":"texture","texture":"o","at_m":0.1,"gain_m_per_n":1,"ends":"loop"})";
  const std::string mirrors =
      R"({"type":"texture","texture":"o","at_m":0.1,"gain_m_per_n":1,"ends":"mirror"})";
  expect_refused(scene_text(stops + "," + loops), ErrorKind::unsuitable, "s.scene.json#/layers/1/ends");
  expect_refused(scene_text(mirrors + "," + stops), ErrorKind::unsuitable, "s.scene.json#/layers/0/ends");
}

TEST(Scene, FaultsAreNamedByJsonPointer) {
  expect_refused(scene_text(R"({"type":"texture","texture":"oak","at_m":0.01})"), ErrorKind::malformed,
                 "s.scene.json#/layers/0");
  expect_refused(
      scene_text(std::string(kOak) + "," + R"({"type":"texture","texture":"","at_m":0,"gain_m_per_n":1e-3})"),
      ErrorKind::malformed, "s.scene.json#/layers/1/texture");
  expect_refused(scene_text(R"({"type":"texture","texture":"oak","at_m":"here","gain_m_per_n":1e-3})"),
                 ErrorKind::malformed, "s.scene.json#/layers/0/at_m");
  expect_refused(scene_text(R"({"type":"texture","texture":"o","at_m":0,"gain_m_per_n":1,"ends":"round"})"),
                 ErrorKind::malformed, "s.scene.json#/layers/0/ends");
  expect_refused(scene_text(""), ErrorKind::malformed, "s.scene.json#/layers");
  expect_refused(scene_text(kOak, "2.0"), ErrorKind::unsupported_version, "s.scene.json");
}

TEST(Scene, WhatIsMisspeltIsRefusedWithTheNearest) {
  const std::string body = R"("type":"texture","texture":"oak","at_m":0,"gain_m_per_n":0.001)";
  for (const auto& [text, where, remedy] :
       {std::tuple{scene_text("{" + body + R"(,"end":"mirror"})"), "s#/layers/0/end", "did you mean 'ends'?"},
        std::tuple{
            R"({"kind":"scene","version":"1.0","playback":{"energy_rms":1},"layers":[{)" + body + "}]}",
            "s#/playback/energy_rms", "did you mean 'energy_rms_v'?"},
        std::tuple{R"({"kind":"scene","version":"1.0","light":"dim","layers":[{)" + body + "}]}", "s#/light",
                   "the known members are kind, version, name, notes, created, creator, playback, layers, "
                   "patches, pieces, contact, radius_m, tool_m"}}) {
    const auto scene = parse_scene(text, "s");
    ASSERT_FALSE(scene) << text;
    EXPECT_EQ(scene.error().kind, ErrorKind::malformed);
    EXPECT_EQ(scene.error().where, where) << message(scene.error());
    EXPECT_EQ(scene.error().remedy, remedy) << message(scene.error());
  }
}

TEST(Scene, ALayerOfAnotherTypeIsRefusedByItsName) {
  const std::string wall = R"({"type":"wall","at_m":0.05,"stiffness_n_per_m":1000})";
  expect_refused(scene_text(std::string(kOak) + "," + wall), ErrorKind::unsuitable,
                 "s.scene.json#/layers/1/type");
}

TEST(Scene, ANewerMinorVersionIsReadAndItsMembersAreKept) {
  const auto scene = parse_scene(
      R"({"kind":"scene","version":"1.7","layers":[)" + std::string(kOak) + R"(],"light":"dim"})", "s");
  ASSERT_TRUE(scene) << message(scene.error());
  EXPECT_EQ(scene->newer_version, "1.7");
  EXPECT_EQ(scene->extra_json, R"({"light":"dim"})");
}

TEST(Scene, TheCheckLooksForTheTextures) {
  tests::TemporaryFolder folder;
  Texture oak;
  oak.signal = {1e-6, 0, std::vector<double>(100, 0.5)};
  ASSERT_TRUE(write_texture(folder / "oak", oak));
  Scene scene;
  scene.layers = {TextureLayer{"oak", 0, 1e-3, "", "", TextureEnds::stop, ""},
                  TextureLayer{"elm", 0, 1e-3, "", "", TextureEnds::stop, ""}};
  ASSERT_TRUE(write_scene(folder / "both", scene));
  const auto checked = check_file({FileKind::scene, folder / "both.scene.json"});
  ASSERT_TRUE(checked);
  ASSERT_EQ(checked->findings.size(), 1U);
  EXPECT_TRUE(checked->findings[0].where.ends_with("#/layers/1/texture")) << checked->findings[0].where;
}

}  // namespace
}  // namespace tacto::schema
