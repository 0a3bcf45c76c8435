// SPDX-License-Identifier: GPL-3.0-or-later
// `design` of 16 patches with four layers each at 1 kHz: at most 0.1 s, with simulated taps 5 s; an adversary
// with 10,000 paths: at most 0.2 s.
#include <benchmark/benchmark.h>

#include <string>
#include <utility>

#include "analysis/design/design_page.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/stability/adversary.hpp"

namespace tacto::analysis {
namespace {

constexpr double kDesignRate_hz = 1000;

schema::Scene sixteen_patches() {
  schema::Scene scene;
  for (int i = 0; i < 16; ++i) {
    schema::GroovesLayer grooves;
    grooves.period_m = {1e-3}, grooves.depth_m = {1e-4}, grooves.kappa_n = {0.2};
    schema::NoiseLayer noise;
    noise.period_m = {2e-3}, noise.octaves = {3}, noise.depth_m = {1e-4}, noise.kappa_n = {0.2};
    schema::SpringLayer spring;
    spring.stiffness_n_per_m = {300.0 + 20 * i};
    schema::DamperLayer damper;
    damper.damping_n_s_per_m = {1 + 0.2 * i};
    schema::Patch patch;
    patch.name = "p" + std::to_string(i);
    patch.x_m = 0.024 * (i % 4 - 1.5), patch.y_m = 0.024 * (i / 4 - 1.5);
    patch.width_m = patch.height_m = 0.023;
    patch.layers = {spring, damper, grooves, noise};
    scene.patches.push_back(std::move(patch));
  }
  return scene;
}

void design_of_sixteen(benchmark::State& state, bool simulate) {
  DesignRequest request;
  request.device = *schema::read_device("sandpaper-1990");
  request.rate_hz = kDesignRate_hz;
  request.simulate = simulate;
  schema::Scene scene = sixteen_patches();
  if (!playback::set_filters(scene, 1e3, "bench")) state.SkipWithError("no filter");
  for (auto _ : state) {
    const auto design = design_scene(scene, "bench", request);
    benchmark::DoNotOptimize(design_tables(*design).needs.size());
  }
}

void DesignOf16Patches(benchmark::State& state) {
  design_of_sixteen(state, false);
}
BENCHMARK(DesignOf16Patches)->Name("design_of_16_patches")->Unit(benchmark::kMillisecond);
void DesignOf16PatchesSimulated(benchmark::State& state) {
  design_of_sixteen(state, true);
}
BENCHMARK(DesignOf16PatchesSimulated)->Name("design_of_16_patches_simulated")->Unit(benchmark::kMillisecond);

void AdversaryOf10000Paths(benchmark::State& state) {
  const schema::DeviceAxis axis = schema::read_device("sandpaper-1990")->axes.front();
  for (auto _ : state)
    benchmark::DoNotOptimize(
        playback::least_generating_stiffness(axis, {1 / kDesignRate_hz, 0}, 1, 0.05, 10'000, 33));
}
BENCHMARK(AdversaryOf10000Paths)->Name("adversary_of_10000_paths")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tacto::analysis
