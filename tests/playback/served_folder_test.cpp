// SPDX-License-Identifier: GPL-3.0-or-later
// The files that clients over TCP may load; they get no information about other files.
#include "playback/player/served_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "data-schema/files/files.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::playback {
namespace {

namespace fs = std::filesystem;

class ServedFolder : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "served/deeper");
    fs::create_directories(folder_ / "other");
    schema::Texture texture;
    texture.signal.pitch_m = 1e-5;
    texture.signal.values = {0, 1, 2, 3};
    for (const char* stem : {"served/oak", "served/deeper/elm", "other/secret"})
      ASSERT_TRUE(schema::write_texture(folder_ / stem, texture));
  }
  void write_scene(const std::string& stem, const std::string& texture) {
    schema::Scene scene;
    schema::TextureLayer layer;
    layer.texture = texture;
    scene.layers = {layer};
    ASSERT_TRUE(schema::write_scene(folder_ / stem, scene));
  }
  bool served(const std::string& file) const { return served_file(home_, file).has_value(); }
  // The message without the requested name.
  std::string refusal(const std::string& file) const {
    const auto refused = served_file(home_, file);
    return refused ? "served" : refused.error().what + "; " + refused.error().remedy;
  }

  tests::TemporaryFolder folder_;
  std::string home_ = folder_ / "served";
};

TEST_F(ServedFolder, WhatIsInItIsServed) {
  write_scene("served/bench", "deeper/elm");
  for (const char* file :
       {"oak", "oak.texture.json", "oak.texture.wav", "deeper/elm", "./oak", "bench", "bench.scene.json"})
    EXPECT_TRUE(served(file)) << refusal(file);
}

TEST_F(ServedFolder, TheHeightMapsOfAScene) {
  schema::HeightMap map;
  map.columns = map.rows = 2, map.pitch_m = 1e-3;
  map.height_m = {0, 1e-4F, 0, 0};
  for (const char* stem : {"served/deeper/plate", "other/plate"})
    ASSERT_TRUE(
        schema::write_height_map(schema::height_map_path(folder_ / stem), map, schema::Existing::keep));
  for (const char* file : {"deeper/plate", "../other/plate", "absent"}) {
    schema::Patch patch;
    patch.name = "a";
    patch.width_m = patch.height_m = 0.1;
    patch.layers = {schema::HeightMapLayer{file, {1}, "", 0}};
    schema::Scene scene;
    scene.patches = {patch};
    ASSERT_TRUE(schema::write_scene(folder_ / "served/relief", scene));
    EXPECT_EQ(served("relief"), std::string(file) == "deeper/plate") << file;
  }
}

TEST_F(ServedFolder, TheTexturesOfAPatch) {
  for (const char* file : {"deeper/elm", "../other/secret", "absent"}) {
    schema::Patch patch;
    patch.name = "a";
    patch.width_m = patch.height_m = 0.1;
    patch.layers = {schema::TextureForceLayer{file, {0}, {1}, "", 0}};
    schema::Scene scene;
    scene.patches = {patch};
    ASSERT_TRUE(schema::write_scene(folder_ / "served/drawn", scene));
    EXPECT_EQ(served("drawn"), std::string(file) == "deeper/elm") << file;
  }
}

TEST_F(ServedFolder, TheTablesOfAPatch) {
  for (const char* stem : {"served/deeper/table.csv", "other/table.csv"}) {
    schema::PendingFiles pending;
    ASSERT_TRUE(pending.write(folder_ / stem, "x_m,y_m,fx_n,fy_n\n0,0,1,1\n1,0,1,1\n"));
    ASSERT_TRUE(pending.commit());
  }
  for (const char* file : {"deeper/table.csv", "../other/table.csv", "absent.csv"}) {
    schema::FieldLayer field;
    field.file = file;
    field.length_scale = {1e7};
    schema::ForceMapLayer map;
    map.file = file;
    for (const schema::ForceLayer& layer : {schema::ForceLayer(field), schema::ForceLayer(map)}) {
      schema::Patch patch;
      patch.name = "a";
      patch.width_m = patch.height_m = 0.1;
      patch.layers = {layer};
      schema::Scene scene;
      scene.patches = {patch};
      ASSERT_TRUE(schema::write_scene(folder_ / "served/table", scene));
      EXPECT_EQ(served("table"), std::string(file) == "deeper/table.csv") << file << schema::type_of(layer);
    }
  }
}

TEST_F(ServedFolder, WhatIsElsewhereAndWhatIsMissingHaveOneError) {
  const std::string missing = refusal("elm");
  const std::string outside = folder_ / "other/secret", absent = folder_ / "other/absent";
  for (const std::string& file :
       {outside, absent, std::string("../other/secret"), std::string("../other/absent"),
        std::string("deeper/../../other/secret"), std::string("deeper/../oak"), home_ + "/oak",
        std::string(".."), std::string("/etc/passwd"), std::string()})
    EXPECT_EQ(refusal(file), missing) << file;
}

TEST_F(ServedFolder, ALinkLeadsNowhereElse) {
  fs::create_symlink(folder_ / "other", home_ + "/way");
  for (const char* ending : {".texture.json", ".texture.wav"})
    fs::create_symlink(folder_ / "other/secret" + ending, home_ + "/borrowed" + ending);
  for (const char* file : {"way/secret", "borrowed"}) EXPECT_EQ(refusal(file), refusal("elm")) << file;
  for (const char* ending : {".texture.json", ".texture.wav"})
    fs::create_symlink(home_ + "/oak" + ending, home_ + "/ash" + ending);
  EXPECT_TRUE(served("ash")) << "a link within the folder";
  fs::remove(home_ + "/ash.texture.wav");
  fs::create_symlink(home_ + "/oak.texture.json", home_ + "/pine.texture.json");
  fs::remove(home_ + "/oak.texture.wav");
  fs::create_symlink(folder_ / "other/secret.texture.wav", home_ + "/oak.texture.wav");
  EXPECT_EQ(refusal("oak"), refusal("elm")) << "the samples lie elsewhere";
}

TEST_F(ServedFolder, ASceneThatReachesOutIsNotServed) {
  write_scene("served/far", "../other/secret");
  write_scene("served/farther", folder_ / "other/secret");
  for (const char* file : {"far", "farther"}) EXPECT_EQ(refusal(file), refusal("elm")) << file;
}

TEST_F(ServedFolder, WithoutAFolderNothingIsServed) {
  EXPECT_NE(served_file("", "oak").error().remedy.find("files"), std::string::npos);
}

}  // namespace
}  // namespace tacto::playback
