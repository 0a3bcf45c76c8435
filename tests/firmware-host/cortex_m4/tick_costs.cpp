// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the parts of a tick, for the table of boards (firmware-host/boards/boards.hpp): prints each as
// measured, in counts, and as in the table, in instructions.
#include "firmware-host/boards/boards.hpp"
#include "tests/firmware-host/cortex_m4/board.hpp"
#include "tests/firmware-host/kernel_workload.hpp"

inline void* operator new(size_t, void* place) noexcept {
  return place;
}

namespace tacto::cortex_m4 {
namespace {

#if __ARM_ARCH >= 8
constexpr boards::TickCosts kTable = boards::kTickCosts[static_cast<int>(boards::Core::cortex_m33)];
#else
constexpr boards::TickCosts kTable = boards::kTickCosts[static_cast<int>(boards::Core::cortex_m4)];
#endif

constexpr uint32_t kTicks = 3000, kTicksPerChange = 500;

// `parts`: of how many equal parts this is the cost.
void say_cost(const char* name, uint32_t counts, uint32_t parts, uint32_t tabled) {
  say("cost ");
  say(name);
  say(" parts", parts);
  say("counts", counts);
  say("tabled", tabled);
}

alignas(8) uint8_t memory[sizeof(tests::TextureWorkload)];

// The dearest tick, and during changes both textures are read.
uint32_t most_of(const tests::TextureParts& parts) {
  auto& texture = *new (memory) tests::TextureWorkload(parts);
  uint32_t most = 0;
  for (uint32_t i = 0; i < kTicks; ++i) {
    const uint32_t before = counter();
    if (i % kTicksPerChange == 0) texture.change(0.01F);
    texture.tick();
    const uint32_t counts = counted(before, counter());
    if (counts > most) most = counts;
  }
  return most;
}

void count_texture() {
  const char* const kNames[4] = {"nearest", "linear", "hermite", "sinc"};
  for (uint8_t i = 0; i < 4; ++i)
    say_cost(kNames[i], most_of({static_cast<wire::Interpolation>(i), 0}), 1, kTable.read[i]);
  static wire::Section sections[wire::kMaxSections];
  for (wire::Section& section : sections) section = {1, 0.1F, 0.05F, -0.2F, 0.1F};
  static wire::Hysteresis hysteresis;
  hysteresis.count = wire::kMaxPlays;
  for (wire::HysteresisPlay& play : hysteresis.play_operators) play = {0.1F, 0.01F};
  const auto kind = wire::Interpolation::linear;
  const uint32_t plain = most_of({kind, 0});
  say_cost("sixteen_taps", most_of({kind, 64}) - plain, 4, kTable.sixteen_taps);
  say_cost("section", most_of({kind, 0, sections, wire::kMaxSections}) - plain, wire::kMaxSections,
           kTable.section);
  say_cost("four_plays", most_of({kind, 0, nullptr, 0, &hysteresis}) - plain, wire::kMaxPlays / 4,
           kTable.four_plays);
}

tests::SceneWorkload workload;
auto block = workload.block();
core::SceneKernel kernel;
constexpr uint32_t kPatches = 32;
core::ScenePatch patches[kPatches];
float live[200];

constexpr core::ForceSetup plane_setup() {
  core::ForceSetup setup;
  setup.axes[0] = {core::AxisAlong::x, 1e-5F, 20, 5};
  setup.axes[1] = {core::AxisAlong::y, 1e-5F, 20, 5};
  setup.axis_count = 2;
  setup.peak_n = 20, setup.continuous_n = 5;
  setup.slew_n_per_s = 8000, setup.rate_hz = 4000;
  setup.onset_s = setup.release_s = 0.02F;
  return setup;
}

// The dearest tick of that many patches under the hand, the first of which has this layer, or none: while
// sixteen numbers and sixteen places change, and the hand moves at up to 60 counts per tick.
uint32_t most_of_scene(uint32_t patch_count, uint32_t layer, uint16_t layers) {
  core::SceneView view;
  view.patches = patches, view.layers = block.layers, view.numbers = block.numbers;
  view.tables = reinterpret_cast<const uint32_t*>(&block.grooves);
  view.patch_count = patch_count, view.layer_count = 12;
  view.number_count = sizeof block.numbers / sizeof(float);
  view.needs_speed = true;
  for (core::ScenePatch& patch : patches) patch = {0, 0, 0.8F, 0.6F, 1, 1, 0, 0, 1};
  patches[0].first_layer = static_cast<uint16_t>(layer), patches[0].layers = layers;
  kernel.set(view, plane_setup(), live);
  tests::WorkloadRandom next{11};
  uint32_t most = 0;
  int32_t counts[2] = {}, speed[2] = {};
  for (uint32_t i = 0; i < kTicks; ++i) {
    if (i % kTicksPerChange == 0) {
      for (uint32_t j = 0; j < 12; ++j) kernel.change(j, 0, 1 + 0.01F * static_cast<float>(i % 7), 1000);
      for (uint32_t j = 0; j < patch_count && j < core::kMostRamps; ++j)
        kernel.move(j, {static_cast<int32_t>(i % 11), 5}, 1000);
    }
    for (int j = 0; j < 2; ++j) {
      const int32_t draw = next();
      if (draw % 200 == 0) speed[j] = (draw >> 4) % 61;
      if (counts[j] > 5000 || counts[j] < -5000) speed[j] = counts[j] > 0 ? -5 : 5;
      counts[j] += speed[j];
    }
    const uint32_t before = counter();
    kernel.tick(counts, true);
    const uint32_t ticked = counted(before, counter());
    if (ticked > most) most = ticked;
  }
  return most;
}

void count_scene() {
  const uint32_t none = most_of_scene(0, 0, 0), bare = most_of_scene(1, 0, 0);
  say_cost("scene", none, 1, kTable.scene);
  say_cost("patch", most_of_scene(kPatches, 0, 0) - none, kPatches, kTable.patch);
  const char* const kNames[boards::kPlaneKinds] = {"spring",     "damper",    "grooves",    "noise",
                                                   "height_map", "body",      "lasso",      "mover",
                                                   "field",      "force_map", "tick_damper"};
  const auto cost = [&](uint32_t layer) {
    const uint32_t with = most_of_scene(1, layer, 1);
    return with > bare ? with - bare : 0;
  };
  uint32_t* const units[3] = {&block.grooves.table.harmonics, &block.noise.table.octaves,
                              &block.field.table.atoms};
  const uint16_t unit_kinds[3] = {2, 3, 8};
  const char* const kUnits[3] = {"harmonic", "octave", "atom"};
  const uint32_t tabled_units[3] = {kTable.harmonic, kTable.octave, kTable.atom};
  bool seen[boards::kPlaneKinds] = {};
  for (uint32_t layer = 0; layer < 12; ++layer) {
    const uint16_t kind = tests::SceneWorkload::kKinds[layer];
    if (seen[kind]) continue;
    seen[kind] = true;
    uint32_t whole = cost(layer), own = whole;
    for (int i = 0; i < 3; ++i) {
      if (kind != unit_kinds[i]) continue;
      const uint32_t all = *units[i];
      *units[i] = 1;
      const uint32_t one = cost(layer);
      *units[i] = all;
      say_cost(kUnits[i], whole - one, all - 1, tabled_units[i]);
      own = one - (whole - one) / (all - 1);
    }
    say_cost(kNames[kind], own, 1, kTable.layer[kind]);
  }
}

}  // namespace

void run() {
  calibrate();
  count_texture();
  count_scene();
  say("cost around parts", 0);
  say("tabled", kTable.around);
  say("cost poll parts", 0);
  say("tabled", kTable.poll);
  end(true);
}

}  // namespace tacto::cortex_m4
