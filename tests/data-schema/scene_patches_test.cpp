// SPDX-License-Identifier: GPL-3.0-or-later
// Patches of force layers in scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <concepts>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "data-schema/base/unknown_note.hpp"
#include "data-schema/check/check.hpp"
#include "data-schema/files/embedded_files.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/scene/atoms.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/texture/texture.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using Body = nlohmann::json;

// One layer of each kind, each with what it needs.
const Body kLayers = {
    {{"type", "height_map"}, {"file", "relief"}, {"kappa_n", 1.5}},
    {{"type", "grooves"}, {"profile", "square"}, {"period_m", 1e-3}, {"depth_m", 2e-4}, {"kappa_n", 1}},
    {{"type", "noise"}, {"period_m", 2e-3}, {"depth_m", 2e-4}, {"kappa_n", 0.5}, {"octaves", 4}, {"seed", 7}},
    {{"type", "texture"}, {"file", "oak"}, {"direction_deg", 90}, {"gain", -2}},
    {{"type", "spring"}, {"stiffness_n_per_m", 100}, {"centre_x_m", 0.01}},
    {{"type", "damper"}, {"damping_n_s_per_m", 5}},
    {{"type", "body"}, {"mass_kg", 0.3}, {"stiffness_n_per_m", 400}, {"static_friction_n", 1}},
    {{"type", "lasso"}, {"mass_kg", 0.1}, {"stiffness_n_per_m", 200}, {"length_m", 0.03}},
    {{"type", "mover"}, {"speed_mps", -0.1}, {"damping_n_s_per_m", 3}},
    {{"type", "force_map"}, {"file", "forces.csv"}},
    {{"type", "field"}, {"file", "atoms.csv"}, {"length_scale", 1e7}, {"force_scale", 1e10}, {"z_m", 1e-3}}};

Body patch_body(const std::string& name, const Body& layers) {
  return {{"name", name},
          {"place", {{"x_m", 0.01}, {"y_m", -0.02}}},
          {"size", {{"width_m", 0.1}, {"height_m", 0.05}}},
          {"layers", layers}};
}

Body scene_body(const Body& patches, const std::string& version = "1.0") {
  return {{"kind", "scene"}, {"version", version}, {"patches", patches}};
}

Body all_kinds() {
  return scene_body(Body::array({patch_body("all", kLayers)}));
}

Result<Scene> parsed(const Body& body) {
  return parse_scene(body.dump(), "s");
}

// The scene of all kinds, changed, is refused there and with these words.
void expect_refused(const std::function<void(Body&)>& change, ErrorKind kind, const std::string& where,
                    const std::string& words) {
  Body body = all_kinds();
  change(body);
  const auto scene = parsed(body);
  ASSERT_FALSE(scene) << body;
  EXPECT_EQ(scene.error().kind, kind) << message(scene.error());
  EXPECT_EQ(scene.error().where, where) << message(scene.error());
  EXPECT_NE(message(scene.error()).find(words), std::string::npos) << message(scene.error());
}

Body& layer(Body& scene, std::size_t index) {
  return scene["patches"][0]["layers"][index];
}

Body slider(const Body& value, const Body& from, const Body& to) {
  return {{"value", value}, {"slider", {{"from", from}, {"to", to}}}};
}

Body written(const Scene& scene) {
  tests::TemporaryFolder folder;
  const auto done = write_scene(folder / "w", scene);
  EXPECT_TRUE(done) << message(done.error());
  return Body::parse(read_file(folder / "w.scene.json").value());
}

TEST(ScenePatches, EveryKindIsReadWithItsNumbersAndDefaults) {
  const auto scene = parsed(all_kinds());
  ASSERT_TRUE(scene) << message(scene.error());
  EXPECT_TRUE(scene->layers.empty());
  EXPECT_EQ(scene->newer_version, "");
  ASSERT_EQ(scene->patches.size(), 1U);
  const Patch& patch = scene->patches[0];
  EXPECT_EQ(patch.name, "all");
  EXPECT_EQ(std::tie(patch.x_m, patch.y_m, patch.width_m, patch.height_m),
            std::tuple(0.01, -0.02, 0.1, 0.05));
  EXPECT_EQ(std::tie(patch.angle_deg, patch.order), std::tuple(0.0, 0.0));
  EXPECT_EQ(patch.combine, PatchCombine::topmost);
  ASSERT_EQ(patch.layers.size(), force_layer_types().size());
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    EXPECT_EQ(type_of(patch.layers[i]), kLayers[i]["type"].get<std::string>());
    EXPECT_EQ(type_of(patch.layers[i]), force_layer_types()[i]);
    EXPECT_EQ(file_of(patch.layers[i]), kLayers[i].value("file", ""));
    for (const auto& [name, number, changes, whole] : numbers_of(patch.layers[i])) {
      EXPECT_FALSE(number.slider);
      if (kLayers[i].contains(std::string(name)))
        EXPECT_EQ(number.value, kLayers[i][std::string(name)].get<double>()) << name;
    }
  }
}

// What is not in the file has its default; every kind is handled here, or this does not compile.
TEST(ScenePatches, DefaultsAreThoseOfTheSchema) {
  const auto scene = parsed(all_kinds());
  ASSERT_TRUE(scene);
  const auto expect = [](const LayerNumber& number, double value) { EXPECT_EQ(number, LayerNumber{value}); };
  for (const ForceLayer& each : scene->patches[0].layers)
    each.visit([](const HeightMapLayer&) {}, [](const SpringLayer&) {}, [](const DamperLayer&) {},
               [](const LassoLayer&) {},
               [&](const FieldLayer& of) {
                 expect(of.core, 1);
                 expect(of.probe_charge_c, 0);
               },
               [&](const GroovesLayer& of) {
                 EXPECT_EQ(of.profile, GrooveProfile::square);
                 EXPECT_FALSE(of.filter_m);
                 expect(of.filter_margin, 1.5);
                 expect(of.direction_deg, 0);
               },
               [&](const NoiseLayer& of) { expect(of.roughness, 0.5); },
               [&](const TextureForceLayer& of) { expect(of.gain, -2); },
               [&](const BodyLayer& of) {
                 expect(of.damping_n_s_per_m, 0);
                 expect(of.kinetic_friction_n, 0);
               },
               [&](const MoverLayer& of) { expect(of.direction_deg, 0); },
               [&](const ForceMapLayer& of) { expect(of.gain, 1); });
}

struct OfHeightMaps {
  void operator()(const HeightMapLayer& /*layer*/) const {}
};
struct OfOthers {
  template <class L>
    requires(!std::same_as<L, HeightMapLayer>)
  void operator()(const L& /*layer*/) const {}
};
template <class Value, class... Handlers>
concept CanVisitLayer = requires(Value value, Handlers... handlers) { value.visit(handlers...); };

TEST(ScenePatches, ALayerCanBeReadOnlyByHandlingEveryKind) {
  static_assert(!CanVisitLayer<const ForceLayer, OfHeightMaps>);
  static_assert(CanVisitLayer<const ForceLayer, OfHeightMaps, OfOthers>);
  static_assert(!std::is_convertible_v<ForceLayer, HeightMapLayer>);
}

TEST(ScenePatches, WhatIsWrittenReadsBackAndIsWrittenTheSame) {
  Body body = all_kinds();
  body["name"] = "bench";
  body["playback"] = {{"inverse", "gain"}};
  const Body oak = {{"type", "texture"}, {"texture", "oak"}, {"at_m", 0}, {"gain_m_per_n", 1e-3}};
  body["layers"] = Body::array({oak});
  Body& first = body["patches"][0];
  first["angle_deg"] = 33.3;
  first["order"] = 2;
  first["combine"] = "add";
  layer(body, 1)["filter_m"] = 1e-4;
  layer(body, 2)["depth_m"] = slider(1e-3 / 3, 0, 1e-2 / 3);
  body["patches"].push_back(
      patch_body("second", Body::array({{{"type", "damper"}, {"damping_n_s_per_m", slider(1, 0, 20)}}})));
  const auto scene = parsed(body);
  ASSERT_TRUE(scene) << message(scene.error());
  const Body once = written(*scene);
  EXPECT_EQ(once["version"], "1.0");
  // With the defaults; nothing that was in the file is lost.
  EXPECT_EQ(once["patches"][0]["layers"][2]["depth_m"], slider(1e-3 / 3, 0, 1e-2 / 3));
  for (std::size_t i = 0; i < kLayers.size(); ++i)
    for (const auto& [name, value] : body["patches"][0]["layers"][i].items())
      EXPECT_EQ(once["patches"][0]["layers"][i][name], value) << i << " " << name;
  EXPECT_EQ(once["patches"][0]["place"], body["patches"][0]["place"]);
  EXPECT_EQ(once["patches"][0]["angle_deg"], 33.3);
  EXPECT_EQ(once["patches"][0]["combine"], "add");
  EXPECT_EQ(once["patches"][0]["layers"][0]["file"], "relief");
  const auto again = parsed(once);
  ASSERT_TRUE(again) << message(again.error());
  EXPECT_EQ(written(*again), once);
  EXPECT_EQ(again->layers.size(), 1U);
}

TEST(ScenePatches, AutoIsAWordAndAFilterANumber) {
  Body body = all_kinds();
  layer(body, 1)["filter_m"] = "auto";
  EXPECT_EQ(written(*parsed(body))["patches"][0]["layers"][1]["filter_m"], "auto");
  layer(body, 1)["filter_m"] = 1e-4;
  EXPECT_EQ(written(*parsed(body))["patches"][0]["layers"][1]["filter_m"], 1e-4);
  expect_refused([](Body& b) { layer(b, 1)["filter_m"] = "automatic"; }, ErrorKind::malformed,
                 "s#/patches/0/layers/1/filter_m", "automatic");
}

TEST(ScenePatches, AdaptiveIsAMemberOfLayersWithAStiffness) {
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    Body body = all_kinds();
    layer(body, i)["adaptive"] = true;
    if (i > 4) {  // from damper on
      const auto scene = parsed(body);
      ASSERT_FALSE(scene) << i;
      EXPECT_EQ(scene.error().where, fmt::format("s#/patches/0/layers/{}/adaptive", i));
      continue;
    }
    const auto scene = parsed(body);
    ASSERT_TRUE(scene) << message(scene.error());
    for (std::size_t j = 0; j < kLayers.size(); ++j)
      EXPECT_EQ(is_adaptive(scene->patches[0].layers[j]), i == j) << i << ' ' << j;
    EXPECT_EQ(written(*scene)["patches"][0]["layers"][i]["adaptive"], true) << i;
    layer(body, i)["adaptive"] = false;
    EXPECT_FALSE(written(*parsed(body))["patches"][0]["layers"][i].contains("adaptive")) << i;
  }
  expect_refused([](Body& b) { layer(b, 4)["adaptive"] = 1; }, ErrorKind::malformed,
                 "s#/patches/0/layers/4/adaptive", "");
}

TEST(ScenePatches, TwoTicksIsAMemberOfDampers) {
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    Body body = all_kinds();
    const bool damper = layer(body, i)["type"] == "damper";
    for (const bool two_ticks : {false, true}) {
      layer(body, i)["two_ticks"] = two_ticks;
      const auto scene = parsed(body);
      ASSERT_EQ(scene.has_value(), damper) << i;
      if (damper)
        EXPECT_EQ(written(*scene)["patches"][0]["layers"][i].contains("two_ticks"), two_ticks);
      else
        EXPECT_EQ(scene.error().where, fmt::format("s#/patches/0/layers/{}/two_ticks", i));
    }
  }
}

// Each number of each layer once with a slider, among those that the file has here.
TEST(ScenePatches, OnlyNumbersThatCanChangeMayHaveASlider) {
  const std::set<std::string> fixed = {"1/period_m",      "2/period_m", "2/octaves", "2/seed",
                                       "3/direction_deg", "6/mass_kg",  "7/mass_kg", "10/length_scale"};
  std::set<std::string> refused;
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < kLayers.size(); ++i)
    for (const auto& [name, value] : kLayers[i].items()) {
      if (!value.is_number()) continue;
      Body body = all_kinds();
      const Body to =
          value.is_number_integer() ? Body(value.get<int>() + 1) : Body(value.get<double>() + 1e-3);
      layer(body, i)[name] = slider(value, value, to);
      if (name == "static_friction_n") layer(body, i)["kinetic_friction_n"] = 0;
      const auto scene = parsed(body);
      if (scene) {
        ++accepted;
        continue;
      }
      EXPECT_EQ(scene.error().kind, ErrorKind::unsuitable) << message(scene.error());
      EXPECT_EQ(scene.error().where, fmt::format("s#/patches/0/layers/{}/{}/slider", i, name));
      refused.insert(fmt::format("{}/{}", i, name));
    }
  EXPECT_EQ(refused, fixed);
  EXPECT_EQ(accepted + refused.size(), 25U);
  const auto refused_slider = [](std::size_t at, const std::string& name, const Body& value) {
    expect_refused([&](Body& b) { layer(b, at)[name] = value; }, ErrorKind::unsuitable,
                   fmt::format("s#/patches/0/layers/{}/{}/slider", at, name), "");
  };
  refused_slider(1, "filter_m", slider(1e-4, 0, 1e-3));
  refused_slider(1, "filter_margin", slider(2, 1.5, 3));
  refused_slider(2, "roughness", slider(0.5, 0.4, 0.6));
  refused_slider(7, "damping_n_s_per_m", slider(0.5, 0.4, 0.6));
  refused_slider(8, "direction_deg", slider(0, 0, 90));
  refused_slider(10, "core", slider(1, 0.9, 1.1));
  refused_slider(10, "probe_charge_c", slider(0, -1e-19, 1e-19));
}

TEST(ScenePatches, ASceneOfATrayIsWrittenAsItWasRead) {
  const Body oak = {
      {"type", "texture"}, {"texture", "oak"}, {"at_m", 0.01}, {"gain_m_per_n", 1e-3}, {"ends", "loop"}};
  const Body tray = {{"kind", "scene"}, {"version", "1.0"}, {"layers", Body::array({oak})}};
  const auto scene = parsed(tray);
  ASSERT_TRUE(scene) << message(scene.error());
  EXPECT_TRUE(check_only_tray(*scene, "s"));
  EXPECT_EQ(written(*scene), tray);
}

TEST(ScenePatches, ATraysCommandsRefuseItWithOneError) {
  const auto refused = check_only_tray(*parsed(all_kinds()), "s.scene.json");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(refused.error().where, "s.scene.json#/patches");
}

TEST(ScenePatches, WithoutPatchesItNeedsLayers) {
  expect_refused([](Body& b) { b["version"] = "2.0"; }, ErrorKind::unsupported_version, "s", "2.0");
  expect_refused([](Body& b) { b.erase("patches"); }, ErrorKind::malformed, "s", "'layers'");
  expect_refused([](Body& b) { b["patches"] = Body::array(); }, ErrorKind::malformed, "s#/patches", "");
}

TEST(ScenePatches, AnUnknownTypeIsRefusedWithTheNearest) {
  const auto type = [](const char* word) { return [word](Body& b) { layer(b, 4)["type"] = word; }; };
  expect_refused(type("sprint"), ErrorKind::unsuitable, "s#/patches/0/layers/4/type",
                 "did you mean 'spring'?");
  expect_refused(type("groove"), ErrorKind::unsuitable, "s#/patches/0/layers/4/type",
                 "did you mean 'grooves'?");
  expect_refused(type("teleporter"), ErrorKind::unsuitable, "s#/patches/0/layers/4/type",
                 "the types are height_map, grooves, noise, texture, spring, damper, body, lasso, mover, "
                 "force_map, field");
  expect_refused(
      [](Body& b) {
        b["version"] = "1.6";
        layer(b, 4)["type"] = "sprint";
      },
      ErrorKind::unsuitable, "s#/patches/0/layers/4/type", "did you mean 'spring'?");
}

TEST(ScenePatches, AnUnknownMemberIsRefusedWithTheNearest) {
  const auto bad = ErrorKind::malformed;
  expect_refused([](Body& b) { layer(b, 1)["filter_margn"] = 1; }, bad, "s#/patches/0/layers/1/filter_margn",
                 "did you mean 'filter_margin'?");
  // A member of another kind.
  expect_refused([](Body& b) { layer(b, 5)["mass_kg"] = 1; }, bad, "s#/patches/0/layers/5/mass_kg",
                 "the known members are type, damping_n_s_per_m");
  expect_refused(
      [](Body& b) {
        layer(b, 6)["mass_kg"] = {{"value", 1}, {"slider", {{"from", 0}, {"to", 2}}}, {"unit", 1}};
      },
      bad, "s#/patches/0/layers/6/mass_kg/unit", "'unit' is unknown here");
  expect_refused([](Body& b) { b["patches"][0]["angel_deg"] = 1; }, bad, "s#/patches/0/angel_deg",
                 "did you mean 'angle_deg'?");
  expect_refused([](Body& b) { b["patches"][0]["place"]["z_m"] = 1; }, bad, "s#/patches/0/place/z_m",
                 "'z_m'");
  expect_refused([](Body& b) { b["patches"][0]["size"]["depth_m"] = 1; }, bad, "s#/patches/0/size/depth_m",
                 "'depth_m'");
  expect_refused([](Body& b) { b["pathces"] = 1; }, bad, "s#/pathces", "'patches'");
  expect_refused(
      [](Body& b) {
        layer(b, 0)["kapa_n"] = layer(b, 0)["kappa_n"];
        layer(b, 0).erase("kappa_n");
      },
      bad, "s#/patches/0/layers/0",
      "Missing required property 'kappa_n'; 'kapa_n' is probably a misspelling of it");
}

TEST(ScenePatches, EveryRequiredMemberIsRequired) {
  const std::set<std::string> optional = {"direction_deg",     "gain", "octaves", "seed", "centre_x_m",
                                          "static_friction_n", "z_m"};
  for (std::size_t i = 0; i < kLayers.size(); ++i)
    for (const auto& [name, value] : kLayers[i].items()) {
      if (optional.contains(name)) continue;
      expect_refused([&, member = name](Body& b) { layer(b, i).erase(member); }, ErrorKind::malformed,
                     fmt::format("s#/patches/0/layers/{}", i), "'" + name + "'");
    }
  for (const char* member : {"name", "place", "size", "layers"})
    expect_refused([&](Body& b) { b["patches"][0].erase(member); }, ErrorKind::malformed, "s#/patches/0",
                   member);
  expect_refused([](Body& b) { b["patches"][0]["place"].erase("y_m"); }, ErrorKind::malformed,
                 "s#/patches/0/place", "y_m");
  expect_refused(
      [](Body& b) {
        layer(b, 5)["damping_n_s_per_m"] = {{"value", 1}};
      },
      ErrorKind::malformed, "s#/patches/0/layers/5/damping_n_s_per_m", "slider");
}

TEST(ScenePatches, NumbersOutOfRangeAreRefusedWithTheRange) {
  const auto bad = ErrorKind::malformed;
  expect_refused([](Body& b) { layer(b, 0)["kappa_n"] = 1e9; }, bad, "s#/patches/0/layers/0/kappa_n",
                 "force = -kappa grad h; from 0 to 1000");
  expect_refused([](Body& b) { layer(b, 1)["period_m"] = 0; }, bad, "s#/patches/0/layers/1/period_m",
                 "from 1e-06");
  expect_refused([](Body& b) { layer(b, 2)["octaves"] = 2.5; }, bad, "s#/patches/0/layers/2/octaves",
                 "integer");
  expect_refused([](Body& b) { layer(b, 2)["octaves"] = 17; }, bad, "s#/patches/0/layers/2/octaves", "to 16");
  expect_refused([](Body& b) { layer(b, 2)["seed"] = -1; }, bad, "s#/patches/0/layers/2/seed", "from 0");
  expect_refused([](Body& b) { layer(b, 1)["profile"] = "round"; }, bad, "s#/patches/0/layers/1/profile",
                 "sine, triangle, square");
  expect_refused([](Body& b) { layer(b, 5)["damping_n_s_per_m"] = -1; }, bad,
                 "s#/patches/0/layers/5/damping_n_s_per_m", "");
  expect_refused([](Body& b) { layer(b, 5)["damping_n_s_per_m"] = "soup"; }, bad,
                 "s#/patches/0/layers/5/damping_n_s_per_m", "number");
  expect_refused([](Body& b) { layer(b, 5)["damping_n_s_per_m"] = slider(1, 0, 1e9); }, bad,
                 "s#/patches/0/layers/5/damping_n_s_per_m/slider/to", "to 10000");
  expect_refused([](Body& b) { layer(b, 5)["damping_n_s_per_m"] = slider(1e9, 0, 10); }, bad,
                 "s#/patches/0/layers/5/damping_n_s_per_m/value", "to 10000");
  expect_refused([](Body& b) { b["patches"][0]["size"]["width_m"] = 0; }, bad, "s#/patches/0/size/width_m",
                 "");
  expect_refused([](Body& b) { b["patches"][0]["name"] = "a.b"; }, bad, "s#/patches/0/name", "");
  expect_refused([](Body& b) { b["patches"][0]["layers"] = Body::array(); }, bad, "s#/patches/0/layers", "");
}

TEST(ScenePatches, AnUnknownCombineIsRefused) {
  expect_refused([](Body& b) { b["patches"][0]["combine"] = "multiply"; }, ErrorKind::malformed,
                 "s#/patches/0/combine", "\"multiply\" is not one of topmost, add");
}

TEST(ScenePatches, AValueOutsideItsSliderIsRefused) {
  const auto bad = ErrorKind::unsuitable;
  const std::string at = "s#/patches/0/layers/5/damping_n_s_per_m";
  const auto with = [](double value, double from, double to) {
    return [=](Body& b) { layer(b, 5)["damping_n_s_per_m"] = slider(value, from, to); };
  };
  expect_refused(with(11, 0, 10), bad, at + "/value",
                 "damping_n_s_per_m is 11, outside its slider from 0 to 10");
  expect_refused(with(1, 2, 10), bad, at + "/value", "");
  expect_refused(with(5, 10, 0), bad, at + "/slider", "");
  expect_refused(with(5, 5, 5), bad, at + "/slider", "from 5 to 5");
}

TEST(ScenePatches, NamesOfPatchesAreDifferent) {
  expect_refused([](Body& b) { b["patches"].push_back(patch_body("all", Body::array({kLayers[6]}))); },
                 ErrorKind::unsuitable, "s#/patches/1/name", "two patches are named 'all'");
}

TEST(ScenePatches, MoreThanTheMostLayersAreRefused) {
  const auto patches_of = [](std::size_t first, std::size_t second) {
    return [=](Body& b) {
      const auto many = [](std::size_t count) { return Body(std::vector<Body>(count, kLayers[6])); };
      b["patches"] = {patch_body("a", many(first)), patch_body("b", many(second))};
    };
  };
  Body fits;
  patches_of(200, kMostLayers - 200)(fits = all_kinds());
  EXPECT_TRUE(parsed(fits));
  expect_refused(patches_of(200, kMostLayers - 199), ErrorKind::unsuitable, "s#/patches/1", "");
  expect_refused(patches_of(kMostLayers + 1, 1), ErrorKind::malformed, "s#/patches/0/layers", "");
  patches_of(kMostLayers, 0)(fits);  // no patch without a layer: the schema's own limit, not the sum
  fits["patches"].erase(1);
  EXPECT_TRUE(parsed(fits));
}

TEST(ScenePatches, BodiesNeedAMassAndNoMoreKineticFriction) {
  const auto bad = ErrorKind::unsuitable;
  expect_refused([](Body& b) { layer(b, 6)["mass_kg"] = 0; }, bad, "s#/patches/0/layers/6/mass_kg",
                 "above 0");
  expect_refused([](Body& b) { layer(b, 7)["mass_kg"] = 0; }, bad, "s#/patches/0/layers/7/mass_kg",
                 "above 0");
  expect_refused([](Body& b) { layer(b, 6)["kinetic_friction_n"] = 1.5; }, bad,
                 "s#/patches/0/layers/6/kinetic_friction_n", "above the static_friction_n of 1");
  // Sliders may not cross, either.
  const auto frictions = [](const Body& kinetic, const Body& at_rest) {
    return [=](Body& b) {
      layer(b, 6)["kinetic_friction_n"] = kinetic;
      layer(b, 6)["static_friction_n"] = at_rest;
    };
  };
  for (const auto& [kinetic, at_rest] :
       {std::pair(slider(0.5, 0, 2), Body(1)), std::pair(Body(0.5), slider(1, 0.4, 2)),
        std::pair(slider(0.5, 0, 0.8), slider(1, 0.7, 2))})
    expect_refused(frictions(kinetic, at_rest), bad, "s#/patches/0/layers/6/kinetic_friction_n", "");
  Body apart = all_kinds();
  frictions(slider(0.5, 0, 0.7), slider(1, 0.7, 2))(apart);
  EXPECT_TRUE(parsed(apart));
}

TEST(ScenePatches, NanIsNeitherReadNorWritten) {
  const std::string nan = R"({"kind":"scene","version":"1.0","patches":[{"name":"a","place":{"x_m":NaN}}]})";
  const auto read = parse_scene(nan, "s");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::malformed);
  EXPECT_NE(read.error().where.find("line 1, column"), std::string::npos) << message(read.error());
  tests::TemporaryFolder folder;
  Scene scene = *parsed(all_kinds());
  scene.patches[0].layers = {SpringLayer{.stiffness_n_per_m = {std::numeric_limits<double>::quiet_NaN()},
                                         .centre_x_m = {},
                                         .centre_y_m = {},
                                         .extra_json = {},
                                         .adaptive = false}};
  const auto refused = write_scene(folder / "nan", scene);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "/patches/0/layers/0/stiffness_n_per_m") << message(refused.error());
  EXPECT_FALSE(is_file(folder / "nan.scene.json"));
}

TEST(ScenePatches, WhatIsRefusedIsNotWritten) {
  tests::TemporaryFolder folder;
  Scene scene = *parsed(all_kinds());
  scene.patches.push_back(scene.patches[0]);
  EXPECT_FALSE(write_scene(folder / "twice", scene));
  scene.patches[1].name = "b";
  scene.patches[1].layers = {DamperLayer{LayerNumber{3, SliderRange{5, 6}}, ""}};
  EXPECT_FALSE(write_scene(folder / "twice", scene));
  EXPECT_EQ(folder.files(), 0U);
}

TEST(ScenePatches, ANewerMinorVersionIsReadAndItsMembersAreKept) {
  Body body = all_kinds();
  body["version"] = "1.7";
  body["light"] = "dim";
  body["patches"][0]["wear"] = {{"rate", 1}};
  body["patches"][0]["place"]["z_m"] = 0.5;
  layer(body, 5)["damping_n_s_per_m"] = slider(1, 0, 2);
  layer(body, 5)["damping_n_s_per_m"]["slider"]["step"] = 0.1;
  layer(body, 5)["shear"] = 3;
  const auto scene = parsed(body);
  ASSERT_TRUE(scene) << message(scene.error());
  EXPECT_EQ(scene->newer_version, "1.7");
  const std::string note = unknown_note("s", *scene);
  for (const char* member : {"light", "patches/0/wear", "patches/0/place/z_m", "patches/0/layers/5/shear",
                             "patches/0/layers/5/damping_n_s_per_m/slider/step"})
    EXPECT_NE(note.find(member), std::string::npos) << note;
  const Body again = written(*scene);
  EXPECT_EQ(again["version"], "1.7");
  EXPECT_EQ(again["light"], "dim");
  EXPECT_EQ(again["patches"][0]["wear"], body["patches"][0]["wear"]);
  EXPECT_EQ(again["patches"][0]["place"], body["patches"][0]["place"]);
  EXPECT_EQ(again["patches"][0]["layers"][5], layer(body, 5));
}

// The schema's members are those of the layers in C++: no more, no fewer.
TEST(ScenePatches, SchemaAndTypesHaveTheSameMembers) {
  std::set<std::string> known = {"type", "file", "profile", "filter_m", "adaptive", "two_ticks"};
  const auto scene = parsed(all_kinds());
  ASSERT_TRUE(scene);
  for (const ForceLayer& each : scene->patches[0].layers)
    for (const auto& [name, number, changes, whole] : numbers_of(each)) known.emplace(name);
  std::set<std::string> in_schema;
  const auto file = std::ranges::find(embedded_files(), "scene.schema.json", &EmbeddedFile::name);
  const Body layer_rule = Body::parse(file->content)["definitions"]["force_layer"];
  for (const auto& [name, rule] : layer_rule["properties"].items()) in_schema.insert(name);
  EXPECT_EQ(in_schema, known);
}

TEST(ScenePatches, TheCheckReadsAllFiles) {
  tests::TemporaryFolder folder;
  const auto put = [&](const std::string& name, const std::string& text) {
    PendingFiles pending;
    ASSERT_TRUE(pending.write(folder / name, text));
    ASSERT_TRUE(pending.commit());
  };
  put("bench.scene.json", all_kinds().dump());
  const auto places = [&] {
    std::vector<std::string> all;
    const auto checked = check_file({FileKind::scene, folder / "bench.scene.json"});
    EXPECT_TRUE(checked);
    for (const Finding& finding : checked->findings)
      all.push_back(finding.where.substr(finding.where.find('#')));
    return all;
  };
  const auto at = [](int i) { return fmt::format("#/patches/0/layers/{}/file", i); };
  EXPECT_EQ(places(), (std::vector{at(0), at(3), at(9), at(10)}));
  HeightMap relief;
  relief.columns = relief.rows = 2, relief.pitch_m = 1e-3;
  relief.height_m = {0, 1e-4F, 0, 0};
  ASSERT_TRUE(write_height_map(folder / "relief.height.nc", relief, Existing::keep));
  put("forces.csv", "x_m,y_m,fx_n,fy_n\n0,0,1,1\n0,1,1,1\n1,0,1,1\n");
  put("atoms.csv", "x_m,y_m,z_m,sigma_m,epsilon_j,charge_c\n0,0,0,-1,1,0\n");
  Texture oak;
  oak.signal = {1e-6, 0, std::vector<double>(100, 0.5)};
  ASSERT_TRUE(write_texture(folder / "oak", oak));
  EXPECT_EQ(places(), (std::vector{at(9), at(10)}));
  put("forces.csv", "x_m,y_m,fx_n,fy_n\n0,0,1,1\n1,0,1,1\n");
  EXPECT_EQ(places(), std::vector{at(10)});
  put("atoms.csv", "x_m,y_m,z_m,sigma_m,epsilon_j,charge_c\n0,0,0,1e-3,1,0\n");
  EXPECT_TRUE(places().empty());
  Body wrong = all_kinds();
  layer(wrong, 5)["damping_n_s_per_m"] = slider(5, 0, 1);
  put("bench.scene.json", wrong.dump());
  EXPECT_EQ(places(), std::vector<std::string>{"#/patches/0/layers/5/damping_n_s_per_m/value"});
}

class AtomFile : public testing::Test {
 protected:
  Result<std::vector<Atom>> read(const std::string& text) {
    PendingFiles pending;
    EXPECT_TRUE(pending.write(folder_ / "atoms.csv", text));
    EXPECT_TRUE(pending.commit());
    return read_atoms(folder_ / "atoms.csv");
  }
  void expect_fault(const std::string& text, const std::string& where, const std::string& words) {
    const auto refused = read(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().kind, ErrorKind::malformed);
    EXPECT_TRUE(refused.error().where.ends_with("atoms.csv, " + where)) << message(refused.error());
    EXPECT_NE(message(refused.error()).find(words), std::string::npos) << message(refused.error());
  }
  const std::string header_ = "x_m,y_m,z_m,sigma_m,epsilon_j,charge_c\n";
  tests::TemporaryFolder folder_;
};

TEST_F(AtomFile, ReadsColumnsInAnyOrder) {
  const auto atoms = read(
      "# of a test\r\nsigma_m, "
      "x_m,y_m,z_m,charge_c,epsilon_j\r\n\r\n1e-3,0.1,-0.2,0.3,-1.6e-19,2\n4,5,6,7,8,9");
  ASSERT_TRUE(atoms) << message(atoms.error());
  ASSERT_EQ(atoms->size(), 2U);
  const Atom& first = atoms->front();
  EXPECT_EQ(std::tie(first.x_m, first.y_m, first.z_m), std::tuple(0.1, -0.2, 0.3));
  EXPECT_EQ(std::tie(first.sigma_m, first.epsilon_j, first.charge_c), std::tuple(1e-3, 2.0, -1.6e-19));
  EXPECT_EQ(atoms->back().epsilon_j, 9);
}

// As spreadsheets and other programs write them.
TEST_F(AtomFile, ReadsAByteOrderMarkAndPlusSigns) {
  const auto atoms = read("\xEF\xBB\xBF" + header_ + "+1e-10,+2,-3,+4,5,+1.6e-19\n");
  ASSERT_TRUE(atoms) << message(atoms.error());
  const Atom& first = atoms->front();
  EXPECT_EQ(std::tie(first.x_m, first.y_m, first.z_m), std::tuple(1e-10, 2.0, -3.0));
  EXPECT_EQ(std::tie(first.sigma_m, first.epsilon_j, first.charge_c), std::tuple(4.0, 5.0, 1.6e-19));
  expect_fault(header_ + "+-1,0,0,1,1,0\n", "line 2", "'+-1' is no finite number");
  expect_fault(header_ + "+,0,0,1,1,0\n", "line 2", "'+' is no finite number");
}

TEST_F(AtomFile, FaultsAreNamedByLine) {
  expect_fault("", "line 1", "no atoms");
  expect_fault(header_, "line 1", "no atoms");
  expect_fault("x_m,y_m,z_m,sigma_m,epsilon_j\n", "line 1", "the column charge_c is missing");
  expect_fault("x_m,y_m,z_m,sigma_m,epsilon,charge_c\n", "line 1", "did you mean 'epsilon_j'?");
  expect_fault("x_m,x_m,z_m,sigma_m,epsilon_j,charge_c\n", "line 1", "x_m appears twice");
  expect_fault("x_m,y_m,z_m,sigma_m,epsilon_j,charge_c,colour\n", "line 1", "the columns are x_m");
  expect_fault(header_ + "0,0,0,1,1\n", "line 2", "5 cells");
  expect_fault(header_ + "0,0,0,1,1,0\n0,nan,0,1,1,0\n", "line 3", "'nan' is no finite number");
  expect_fault(header_ + "0,inf,0,1,1,0\n", "line 2", "'inf' is no finite number");
  expect_fault(header_ + "0,1mm,0,1,1,0\n", "line 2", "'1mm' is no finite number");
  expect_fault(header_ + "0,0,0,0,1,0\n", "line 2", "sigma_m is 0");
  expect_fault(header_ + "0,0,0,1,-1,0\n", "line 2", "epsilon_j is -1");
  expect_fault(header_ + "0,0,0,1e-3,2000,0\n", "line 2", "epsilon_j / sigma_m is 2e+06 N");
  expect_fault(header_ + "0,0,1001,1,1,0\n", "line 2", "a place is 1001 m");
  std::string many = header_;
  for (std::size_t i = 0; i <= kMostAtoms; ++i) many += "0,0,0,1,1,0\n";
  expect_fault(many, "line 4098", "more than 4096 atoms");
  EXPECT_EQ(read_atoms(folder_ / "none.csv").error().kind, ErrorKind::not_found);
}

}  // namespace
}  // namespace tacto::schema
