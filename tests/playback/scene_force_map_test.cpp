// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on a grid: the kernel against the reference and closed forms; stiffness and curl.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/acting_load.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/unlimited_device.hpp"

namespace tacto::playback {
namespace {

using NodeForce = std::function<std::pair<double, double>(double, double)>;

// Of `count` x `count` nodes around the origin, written to a file.
schema::ForceMapLayer force_map(const std::string& name, int count, double pitch_m,
                                const NodeForce& force_n) {
  const std::string path = testing::TempDir() + name + ".csv";
  std::ofstream file(path);
  file << "x_m,y_m,fx_n,fy_n\n";
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i) {
      const double x = (i - 0.5 * (count - 1)) * pitch_m, y = (j - 0.5 * (count - 1)) * pitch_m;
      const auto [fx, fy] = force_n(x, y);
      file << fmt::format("{},{},{},{}\n", x, y, fx, fy);
    }
  schema::ForceMapLayer layer;
  layer.file = path;
  return layer;
}

schema::Patch patch_with(const schema::ForceMapLayer& layer, double size_m) {
  schema::Patch patch;
  patch.name = "map";
  patch.width_m = patch.height_m = size_m;
  patch.layers = {layer};
  return patch;
}

struct MapOnDevice {
  schema::Device device;
  PreparedScene scene;
  core::SceneKernel kernel;
  std::vector<float> live;

  explicit MapOnDevice(const schema::Patch& patch, double encoder_step_m = 1e-7)
      : device(unlimited_device(encoder_step_m)),
        scene(prepared_map(patch)),
        live(scene.view().live_words()) {
    kernel.set(scene.view(), *force_setup_of(device, 1000), live.data());
  }
  PreparedScene prepared_map(const schema::Patch& patch) const {
    schema::Scene one;
    one.patches = {patch};
    auto made = prepare_scene(one, "s.scene.json", device, 1000);
    EXPECT_TRUE(made) << message(made.error());
    return made ? *made : PreparedScene{};
  }
  std::vector<std::int32_t> counts_at(double x_m, double y_m) const {
    const double step_m = device.axes[0].encoder_step_m;
    return {static_cast<std::int32_t>(std::lround(x_m / step_m)),
            static_cast<std::int32_t>(std::lround(y_m / step_m))};
  }
};

// A spring of k = 200 N/m to the origin, and a vortex of s = 30 N/m around it.
std::pair<double, double> swirl(double x, double y) {
  return {-200 * x - 30 * y, 30 * x - 200 * y};
}

// Two sines of 24 samples a period, and a mean.
std::pair<double, double> wavy(double x, double y) {
  const double turn = 2 * std::numbers::pi / 0.024;
  return {0.7 + std::sin(turn * x) * std::cos(turn * y), -0.4 + 0.5 * std::sin(turn * (x + y))};
}

// 2^-22 of the largest coefficients of N, by the pitch.
TEST(SceneForceMap, StiffnessAndCurlAreThoseOfALinearField) {
  const auto layer = force_map("swirl", 65, 1e-3, swirl);
  const MapOnDevice on(patch_with(layer, 0.03));  // edges are beyond
  const ActingLoad load = load_of(on.scene.patches[0].layers[0]);
  EXPECT_NEAR(load.stiffness_n_per_m, 200, 200e-6);
  EXPECT_NEAR(load.curl_n_per_m, 60, 60e-5);
  schema::ForceMapLayer doubled = layer;
  doubled.gain = {1, schema::SliderRange{-2, 1}};
  const MapOnDevice slid(patch_with(doubled, 0.03));
  EXPECT_NEAR(load_of(slid.scene.patches[0].layers[0]).curl_n_per_m, 120, 120e-5);
  const auto spring = [](double x, double y) { return std::pair(-200 * x, -200 * y); };
  const MapOnDevice plain(patch_with(force_map("spring", 65, 1e-3, spring), 0.03));
  EXPECT_EQ(load_of(plain.scene.patches[0].layers[0]).curl_n_per_m, 0);
  EXPECT_EQ(load_of(plain.scene.patches[0].layers[0]).repelling_n_per_m, 0);
}

// Of a saddle: the eigenvalues of its derivatives, by both signs of the gain.
TEST(SceneForceMap, AMapRepelsByItsLargestSlope) {
  const auto saddle = [](double x, double y) { return std::pair(100 * x + 120 * y, 120 * x - 220 * y); };
  // Trace -120, determinant -36400: -60 +- 200.
  schema::ForceMapLayer layer = force_map("saddle", 65, 1e-3, saddle);
  const auto load_at = [&](const schema::LayerNumber& gain) {
    layer.gain = gain;
    const MapOnDevice on(patch_with(layer, 0.03));
    return load_of(on.scene.patches[0].layers[0]);
  };
  EXPECT_NEAR(load_at({1}).stiffness_n_per_m, 260, 260e-6);
  EXPECT_NEAR(load_at({1}).repelling_n_per_m, 140, 140e-6);
  EXPECT_NEAR(load_at({-2}).stiffness_n_per_m, 280, 280e-6);
  EXPECT_NEAR(load_at({-2}).repelling_n_per_m, 520, 520e-6);
  const ActingLoad slid = load_at({1, schema::SliderRange{-0.5, 1}});
  EXPECT_NEAR(slid.stiffness_n_per_m, 260, 260e-6);
  EXPECT_NEAR(slid.repelling_n_per_m, 140, 140e-6);
}

// A turn of radius r gains the curl times its area.
TEST(SceneForceMap, ATurnGainsTheCurlTimesItsArea) {
  MapOnDevice on(patch_with(force_map("turn", 65, 1e-3, swirl), 0.04), 1e-8);
  constexpr int kPlaces = 4000;
  constexpr double kRadius_m = 0.01;
  const auto place = [](double i) {
    const double angle = 2 * std::numbers::pi * i / kPlaces;
    return std::pair(kRadius_m * std::cos(angle), kRadius_m * std::sin(angle));
  };
  double work = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const auto [x0, y0] = place(i);
    const auto [x1, y1] = place(i + 1);
    const auto [x, y] = place(i + 0.5);
    const core::ForceOutput output = on.kernel.tick(on.counts_at(x, y).data(), true);
    work += double{output.force_n[0]} * (x1 - x0) + double{output.force_n[1]} * (y1 - y0);
  }
  const double gained = 60 * std::numbers::pi * kRadius_m * kRadius_m;
  EXPECT_NEAR(work, gained, 1e-5 * gained);  // the polygon: 4e-7; the edges of the spline: 2e-6
}

// At its nodes the force is that of the file: in single precision, at rest.
TEST(SceneForceMap, NodesHaveTheirForce) {
  schema::ForceMapLayer layer = force_map("nodes", 49, 1e-3, wavy);
  layer.gain = {-2.5};
  MapOnDevice on(patch_with(layer, 0.04));
  for (int i = -20; i <= 20; i += 4)
    for (int j = -20; j <= 20; j += 5) {
      on.kernel.set(on.scene.view(), *force_setup_of(on.device, 1000), on.live.data());
      const auto output = on.kernel.tick(on.counts_at(1e-3 * i, 1e-3 * j).data(), true);
      const auto [x_n, y_n] = wavy(1e-3 * i, 1e-3 * j);
      EXPECT_NEAR(output.force_n[0], -2.5 * x_n, 2.5 * 1.7 * 1e-6);
      EXPECT_NEAR(output.force_n[1], -2.5 * y_n, 2.5 * 1.7 * 1e-6);
    }
}

// On a turned patch, at rest and at speeds of all levels; the mean stays also beyond the last one.
TEST(SceneForceMap, SinglePrecisionIsTheReferenceAtEverySpeed) {
  schema::Patch patch = patch_with(force_map("speeds", 49, 1e-3, wavy), 0.05);
  patch.x_m = 0.013, patch.y_m = -0.008, patch.angle_deg = 33;
  double worst = 0;
  for (const double speed_mps : {0.0, 0.5, 4.0, 9.0, 30.0}) {
    MapOnDevice on(patch, 1e-6);
    ExactScene exact(on.scene, on.device, 1000);
    double x_m = 0.013, way = 1;
    for (int i = 0; i < 400; ++i) {
      x_m += way * speed_mps * 1e-3;
      if (std::abs(x_m - 0.013) > 0.02) way = x_m > 0.013 ? -1 : 1;
      const auto counts = on.counts_at(x_m, -0.008 + 3e-5 * i);
      const core::ForceOutput output = on.kernel.tick(counts.data(), true);
      const ExactScene::Output reference = exact.tick(counts);
      for (std::size_t axis = 0; axis < 2; ++axis)
        worst = std::max(worst, std::abs(output.unlimited_n[axis] - reference.unlimited_n[axis]));
    }
  }
  std::printf("  force map: within %.2g N of 1.7 N\n", worst);
  EXPECT_LT(worst, 1.7 * 1e-6);
}

TEST(SceneForceMap, BeyondItsGridTheOutermostForcesContinue) {
  MapOnDevice on(
      patch_with(force_map("small", 5, 1e-3, [](double, double) { return std::pair(0.5, -0.25); }), 0.04));
  const auto output = on.kernel.tick(on.counts_at(0.019, -0.018).data(), true);
  EXPECT_NEAR(output.force_n[0], 0.5, 1e-6);
  EXPECT_NEAR(output.force_n[1], -0.25, 1e-6);
  const auto notes = limits_of_device(on.scene, on.device, *force_setup_of(on.device, 1000), std::nullopt);
  EXPECT_TRUE(
      std::ranges::any_of(notes, [](const std::string& note) { return note.find("small") != note.npos; }));
}

// Of a block: a coefficient out of range, and a table whose second component is missing.
TEST(SceneForceMap, BlocksOutOfRangeAreRefused) {
  const MapOnDevice on(patch_with(force_map("block", 8, 1e-3, wavy), 0.005));
  const auto fault_of = [](std::vector<std::uint32_t> words) {
    const auto bytes = static_cast<std::uint32_t>(words.size() * sizeof(std::uint32_t));
    words[3] = core::scene_check(words.data(), bytes);
    core::SceneView view;
    return core::read_scene_block(words.data(), bytes, view);
  };
  EXPECT_EQ(fault_of(on.scene.words), core::SceneFault::none);
  auto words = on.scene.words;
  words.back() = 0x47000000;  // 32768
  EXPECT_EQ(fault_of(words), core::SceneFault::value);
  words = on.scene.words;
  words.pop_back();
  words[4] -= 1;  // the words of tables
  EXPECT_EQ(fault_of(words), core::SceneFault::structure);
}

}  // namespace
}  // namespace tacto::playback
