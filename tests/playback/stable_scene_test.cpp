// SPDX-License-Identifier: GPL-3.0-or-later
// Damping that is added for adaptive layers, and stiffness that is scaled to the limit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/prepare/scene/stable_scene.hpp"
#include "playback/stability/sampled_spring.hpp"

namespace tacto::playback {
namespace {

constexpr double kHeldRate = 1000;  // Hz

// With forces that no layer here reaches.
schema::Device held_device() {
  schema::Device device = *schema::read_device("sandpaper-1990");
  device.peak_force_n = 1e4;
  for (schema::DeviceAxis& axis : device.axes) {
    axis.encoder_step_m = 1e-6;
    axis.peak_force_n = 1e4;
  }
  return device;
}

schema::Patch held_patch(const std::string& name, double x_m, std::vector<schema::ForceLayer> layers) {
  schema::Patch made;
  made.name = name;
  made.x_m = x_m;
  made.width_m = made.height_m = 0.04;
  made.combine = schema::PatchCombine::add;
  made.layers = std::move(layers);
  return made;
}

schema::SpringLayer held_spring(double stiffness_n_per_m, bool adaptive) {
  return {{stiffness_n_per_m}, {0}, {0}, "", adaptive};
}

schema::Scene held_scene(std::vector<schema::Patch> patches) {
  schema::Scene scene;
  scene.patches = std::move(patches);
  return scene;
}

// Of the damper that was added to a patch; 0 if none was.
double added_to(const schema::Patch& patch) {
  double sum = 0;
  for (const schema::ForceLayer& layer : patch.layers)
    if (is_added(layer)) sum += load_of(layer).most_damping_n_s_per_m;
  return sum;
}

// With it the limit is 1.2 times the stiffness, with a little less it is not. The eigenvalues of the limit
// are checked against NumPy's in design_command_test.py.
TEST(AddedDamping, IsTheLeastThatSuffices) {
  const schema::Device device = held_device();
  for (const double stiffness : {2000.0, 3000.0, 5000.0, 10000.0}) {
    const auto added = added_damping({stiffness, 0, 0, {}}, device, kHeldRate, std::nullopt);
    ASSERT_TRUE(added) << message(added.error());
    const auto limit = [&](double damping) {
      return stiffness_limit({0.1, 1.17, 0}, {1 / kHeldRate, 0}, damping);
    };
    EXPECT_GE(limit(*added), kStableMargin * stiffness) << stiffness;
    EXPECT_LT(limit(0.999 * *added), kStableMargin * stiffness) << stiffness;
  }
  EXPECT_EQ(added_damping({1900, 0, 0, {}}, device, kHeldRate, std::nullopt).value_or(-1), 0);
  // What the scene has already is not added again; the sum differs by the rounding of the bisection.
  const double alone = *added_damping({5000, 0, 0, {}}, device, kHeldRate, std::nullopt);
  EXPECT_NEAR(*added_damping({5000, 1, 1, {}}, device, kHeldRate, std::nullopt) + 1, alone, 1e-6);
}

TEST(AddedDamping, IsRefusedBeyondTheSampledDamperAndTheRounding) {
  schema::Device device = held_device();
  const auto refused = [&](double stiffness) {
    const auto added = added_damping({stiffness, 0, 0, {}}, device, kHeldRate, std::nullopt);
    return !added && added.error().kind == schema::ErrorKind::unsuitable;
  };
  // The largest limit over all damping is about 70 kN/m.
  EXPECT_FALSE(refused(40'000));
  EXPECT_TRUE(refused(80'000));
  // With a tick of delay more than K T is needed: the rounding is beyond the stiffness's own, so that it is
  // the Coulomb friction that has to carry it.
  device.delay_s = 1e-3;
  for (schema::DeviceAxis& axis : device.axes) axis.coulomb_n = 10;
  const double added = *added_damping({5000, 0, 0, {}}, device, kHeldRate, std::nullopt);
  EXPECT_GT(added, 5000 / kHeldRate);
  const double step_n = added * 1e-6 * kHeldRate;
  device.axes[0].coulomb_n = 0.999 * step_n;
  EXPECT_TRUE(refused(5000));
  device.axes[0].coulomb_n = 1.001 * step_n;
  EXPECT_FALSE(refused(5000));
  device.axes[0].mass_kg = device.axes[1].mass_kg = 0;  // as a device on the wire
  EXPECT_TRUE(refused(5000));
}

// So the kernel and its reference compute it as any damper.
TEST(AdaptiveLayer, HasTheBlockOfASpringAndADamperOfTwoTicks) {
  const schema::Device device = held_device();
  const auto adaptive =
      prepare_scene(held_scene({held_patch("a", 0, {held_spring(5000, true)})}), "s", device, kHeldRate);
  ASSERT_TRUE(adaptive) << message(adaptive.error());
  const double added = added_to(adaptive->patches[0]);
  EXPECT_EQ(added, added_damping({5000, 0, 0, {}}, device, kHeldRate, std::nullopt).value_or(-1));
  const auto explicit_damper = prepare_scene(
      held_scene(
          {held_patch("a", 0, {held_spring(5000, false), schema::DamperLayer{{added}, "", false, true}})}),
      "s", device, kHeldRate);
  ASSERT_TRUE(explicit_damper);
  EXPECT_EQ(adaptive->words, explicit_damper->words);
  EXPECT_TRUE(limits_of_device(*adaptive, device, *force_setup_of(device, kHeldRate)).empty());
  // Soft enough: nothing is added, and the block is that of the spring alone.
  const auto soft =
      prepare_scene(held_scene({held_patch("a", 0, {held_spring(500, true)})}), "s", device, kHeldRate);
  const auto plain =
      prepare_scene(held_scene({held_patch("a", 0, {held_spring(500, false)})}), "s", device, kHeldRate);
  EXPECT_EQ(soft->words, plain->words);
}

// 3000 and 1000 N/m side by side and above each other, with a patch without `adaptive`.
TEST(AdaptiveLayer, PatchesThatActTogetherShareTheDamping) {
  const schema::Device device = held_device();
  schema::Scene scene = held_scene({held_patch("a", 0, {held_spring(3000, true)}),
                                    held_patch("b", 0.02, {held_spring(1000, true)}),
                                    held_patch("c", 0.02, {held_spring(500, false)})});
  ASSERT_TRUE(add_adaptive_damping(scene, "s", device, kHeldRate, std::nullopt));
  const double all = *added_damping({4500, 0, 0, {}}, device, kHeldRate, std::nullopt);
  EXPECT_NEAR(added_to(scene.patches[0]), 0.75 * all, 1e-9);  // 3000 of the 4000 that are adaptive
  EXPECT_NEAR(added_to(scene.patches[1]), 0.25 * all, 1e-9);
  EXPECT_EQ(scene.patches[2].layers.size(), 1U);
  for (const PlaceLimit& at : place_limits(scene.patches, device, kHeldRate, std::nullopt))
    EXPECT_LT(at.used(), 1) << at.load.stiffness_n_per_m;
  const std::size_t before = scene.patches[0].layers.size();
  ASSERT_TRUE(add_adaptive_damping(scene, "s", device, kHeldRate, std::nullopt));
  EXPECT_EQ(scene.patches[0].layers.size(), before);
}

TEST(AdaptiveLayer, ARefusalNamesTheLayer) {
  const schema::Device device = held_device();
  const auto refused =
      prepare_scene(held_scene({held_patch("a", -0.05, {held_spring(10, true)}),
                                held_patch("b", 0.05, {held_spring(10, false), held_spring(90'000, true)})}),
                    "s", device, kHeldRate);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_EQ(refused.error().where, "s#/patches/1/layers/1/adaptive");
  // 10 kN/m alone would be damped; the upper end of the slider, 180 N s/m, changes the force by more than the
  // stiffness does at each count.
  const auto slid = prepare_scene(
      held_scene({held_patch(
          "a", 0,
          {held_spring(10'000, true), schema::DamperLayer{{1, schema::SliderRange{0, 180}}, "", false}})}),
      "s", device, kHeldRate);
  ASSERT_FALSE(slid);
  EXPECT_EQ(slid.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_EQ(slid.error().where, "s#/patches/0/layers/1/damping_n_s_per_m/slider/to");
  EXPECT_TRUE(
      prepare_scene(held_scene({held_patch("a", 0, {held_spring(10'000, true)})}), "s", device, kHeldRate));
  // The dampers count among the 256 layers of a scene.
  std::vector<schema::ForceLayer> many(255, held_spring(0, false));
  many.emplace_back(held_spring(5000, true));
  EXPECT_FALSE(prepare_scene(held_scene({held_patch("a", 0, many)}), "s", device, kHeldRate));
  many.erase(many.begin());
  EXPECT_TRUE(prepare_scene(held_scene({held_patch("a", 0, many)}), "s", device, kHeldRate));
}

TEST(HoldStable, ScalesWhatIsBeyondTheLimitAndNothingElse) {
  const schema::Device device = held_device();
  const double limit = stiffness_limit_of(device, kHeldRate, std::nullopt);
  schema::SpringLayer slid{{1000, schema::SliderRange{500, 3 * limit}}, {0.001}, {0}, "", false};
  schema::GroovesLayer grooves{schema::GrooveProfile::sine,
                               {0.001},
                               {1e-4},
                               {1, schema::SliderRange{0, 2}},
                               {0},
                               schema::LayerNumber{0},
                               {1.5},
                               "",
                               false};
  schema::Scene scene = held_scene(
      {held_patch("slid", -0.06, {slid}), held_patch("soft", 0, {held_spring(100, false)}),
       held_patch("both", 0.06, {grooves, held_spring(limit, false), schema::DamperLayer{{1}, "", false}})});
  const double of_grooves = local_stiffness_n_per_m(scene.patches[2].layers[0]);
  // Closed form: 2 N/m kappa, amplitude of half the depth, wave number squared; the amplitude of the table is
  // in single precision.
  EXPECT_NEAR(of_grooves, 2 * 0.5e-4 * std::pow(2e3 * std::numbers::pi, 2), 1e-6 * of_grooves);
  const auto held = hold_stable(scene.patches, device, kHeldRate, std::nullopt);
  ASSERT_TRUE(held) << message(held.error());
  ASSERT_EQ(held->size(), 3U);
  EXPECT_EQ((*held)[0].patch, "slid");
  EXPECT_NEAR((*held)[0].to_n_per_m, limit / kStableMargin, 1e-9 * limit);
  scene.patches[0].layers[0].visit(
      [&](const schema::SpringLayer& spring) {
        EXPECT_NEAR(spring.stiffness_n_per_m.value, 1000 / 3.6, 1e-9);
        EXPECT_NEAR(spring.stiffness_n_per_m.slider->from, 500 / 3.6, 1e-9);
        EXPECT_EQ(spring.centre_x_m.value, 0.001);
      },
      [](const auto& /*other*/) { FAIL(); });
  EXPECT_EQ(load_of(scene.patches[1].layers[0]).stiffness_n_per_m, 100);
  // Both layers by one factor; the damper stays, and its limit counts.
  const double sum = (*held)[1].from_n_per_m + (*held)[2].from_n_per_m;
  const double damped = stiffness_limit_of(device, kHeldRate, std::nullopt, 1);
  EXPECT_GT(sum, damped);
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_EQ((*held)[i].patch, "both");
    EXPECT_NEAR((*held)[i].to_n_per_m / (*held)[i].from_n_per_m, damped / (kStableMargin * sum), 1e-6);
  }
  EXPECT_EQ(load_of(scene.patches[2].layers[2]).most_damping_n_s_per_m, 1);
  EXPECT_TRUE(hold_stable(scene.patches, device, kHeldRate, std::nullopt)->empty());
}

TEST(HoldStable, APreparedSceneKeepsTheOrderOfItsPatches) {
  const schema::Device device = held_device();
  auto scene = prepare_scene(held_scene({held_patch("a", 0, {held_spring(5000, false)}),
                                         held_patch("b", 0.02, {held_spring(10, false)}),
                                         held_patch("c", -0.05, {held_spring(20, false)})}),
                             "s", device, kHeldRate);
  ASSERT_TRUE(scene);
  const std::vector<schema::Patch> before = scene->patches;
  const auto held = hold_stable(*scene, device, kHeldRate, std::nullopt);
  ASSERT_TRUE(held);
  EXPECT_EQ(held->size(), 2U);  // a, and b, which acts together with it
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(scene->patches[i].name, before[i].name);
  EXPECT_TRUE(limits_of_device(*scene, device, *force_setup_of(device, kHeldRate)).empty());
}

TEST(HoldStable, IsRefusedWhereNoStiffnessIsStable) {
  schema::Device device = held_device();
  std::vector<schema::Patch> patches = {held_patch("a", 0, {schema::DamperLayer{{500}, "", false}})};
  const auto refused = [&] {
    const auto held = hold_stable(patches, device, kHeldRate, std::nullopt);
    return !held && held.error().kind == schema::ErrorKind::unsuitable;
  };
  EXPECT_TRUE(refused());  // beyond 2 M / T, 200 N s/m
  patches[0].layers = {held_spring(1, false)};
  EXPECT_FALSE(refused());
  device.axes[0].viscous_n_s_per_m = 0;
  EXPECT_TRUE(refused());
  device.axes[0].mass_kg = 0;
  EXPECT_TRUE(refused());
}

}  // namespace
}  // namespace tacto::playback
