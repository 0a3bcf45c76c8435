// SPDX-License-Identifier: GPL-3.0-or-later
// One place on a surface of a force scene, value and slope: at most 1 us each; of 2000 atoms, at most 10 us.
// Batches of 1000 places.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "firmware-host/core/scene/field.hpp"
#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/noise.hpp"
#include "firmware-host/core/scene/piece.hpp"
#include "firmware-host/core/scene/relief.hpp"
#include "playback/prepare/relief/groove_series.hpp"

namespace tacto::playback {
namespace {

constexpr int kPlaces = 1000;

// Times batches of calls of `place`, which returns a part of a force; ns_per_place is the mean of all
// batches, p99_ns_per_place that of the batch that 1 % exceed.
void time_places(benchmark::State& state, const auto& place) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> batches_ns;
  for (auto _ : state) {
    const auto begin = Clock::now();
    float sum = 0;
    for (int i = 0; i < kPlaces; ++i) sum += place();
    benchmark::DoNotOptimize(sum);
    batches_ns.push_back(std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / kPlaces);
  }
  state.counters["ns_per_place"] = benchmark::Counter(
      kPlaces * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  const auto p99 = batches_ns.begin() + static_cast<std::ptrdiff_t>(batches_ns.size() * 99 / 100);
  std::ranges::nth_element(batches_ns, p99);
  state.counters["p99_ns_per_place"] = *p99;
}

void SceneFractalOf8Octaves(benchmark::State& state) {
  const float weights[8] = {1, 0.7F, 0.5F, 0.35F, 0.25F, 0.18F, 0.13F, 0.09F};
  const core::NoiseTable table = core::shuffled_noise(1);
  core::Q32 x = 0, y = 0;
  time_places(state, [&] {
    return core::fractal_noise(table, x += 77'777'777, y -= 33'333'333, 0, weights, 8).by_x;
  });
}
BENCHMARK(SceneFractalOf8Octaves);

void SceneSquareGrooves(benchmark::State& state) {
  std::vector<float> amplitudes;
  for (const double amplitude : groove_amplitudes(schema::GrooveProfile::square, 1.0 / 76))
    amplitudes.push_back(static_cast<float>(amplitude));
  const core::Grooves grooves{amplitudes.data(), static_cast<std::uint32_t>(amplitudes.size())};
  std::uint32_t phase = 0;
  time_places(state, [&] { return core::groove_at(grooves, phase += 12'345'678, 1e-3F).by_phase; });
}
BENCHMARK(SceneSquareGrooves);

// Two levels of a map of 4096 x 4096, as the kernel mixes them; places along a line, and far from each other.
void relief_of_two_levels(benchmark::State& state, std::int64_t step) {
  constexpr std::uint32_t kFine = 4096, kCoarse = 2896;
  std::vector<float> fine(std::size_t{kFine} * kFine), coarse(std::size_t{kCoarse} * kCoarse);
  for (std::size_t i = 0; i < fine.size(); ++i) fine[i] = static_cast<float>(i * 7919 % 1000);
  for (std::size_t i = 0; i < coarse.size(); ++i) coarse[i] = static_cast<float>(i * 7919 % 1000);
  const core::ReliefLevel levels[2] = {{fine.data(), kFine, kFine}, {coarse.data(), kCoarse, kCoarse}};
  std::uint64_t x = 1, y = 2;
  constexpr std::uint64_t kWithin = (std::uint64_t{2800} << 32) - 1;
  time_places(state, [&] {
    x = (x + static_cast<std::uint64_t>(step)) % kWithin;
    y = (y + static_cast<std::uint64_t>(step) * 3) % kWithin;
    float sum = 0;
    for (const core::ReliefLevel& level : levels) {
      const core::ReliefSample at = relief_at(level, static_cast<core::Q32>(x), static_cast<core::Q32>(y));
      sum += at.by_x + at.by_y;
    }
    return sum;
  });
}
void SceneReliefTwoLevels(benchmark::State& state) {
  relief_of_two_levels(state, std::int64_t{1} << 29);
}
BENCHMARK(SceneReliefTwoLevels);
void SceneReliefTwoLevelsCold(benchmark::State& state) {
  relief_of_two_levels(state, std::int64_t{1'234'567'890'123});
}
BENCHMARK(SceneReliefTwoLevelsCold);

// At most 10 us a place.
void SceneFieldOf2000Atoms(benchmark::State& state) {
  std::vector<core::FieldAtom> atoms(2000);
  std::uint32_t draw = 1;
  for (core::FieldAtom& atom : atoms) {
    atom.x = static_cast<std::int32_t>(draw = draw * 1664525U + 1013904223U) / 8;
    atom.y = static_cast<std::int32_t>(draw = draw * 1664525U + 1013904223U) / 8;
    atom.squared_sigma = 1e15F;
    atom.lennard_jones = 1e-12F, atom.coulomb = 1e-14F;
  }
  std::int32_t x = 0, y = 0;
  time_places(state, [&] {
    x = (x + 7919) & 0xFFFFFFF, y = (y + 104729) & 0xFFFFFFF;
    return core::field_force(atoms.data(), 2000, 1, x, y, 0).x;
  });
}
BENCHMARK(SceneFieldOf2000Atoms);

// The place of an ellipsoid of 50, 40 and 30 mm that is nearest to a hand 2 % below it, which moves by 0.4
// mrad from place to place: at most 0.3 us, and on the surface within 1e-6 of its equation (its constant is
// 1).
void SceneNearestOnEllipsoid(benchmark::State& state) {
  constexpr float kHalf_m[3] = {0.05F, 0.04F, 0.03F};
  core::PieceTable table;
  for (int i = 0; i < 3; ++i) table.form[i] = 1 / (kHalf_m[i] * kHalf_m[i]);
  table.form[9] = -1;
  core::SpaceVector at = {kHalf_m[0], 0, 0};
  double turn = 0, worst = 0;
  time_places(state, [&] {
    turn += 4e-4;
    const auto along = [&](int i, double way) { return static_cast<float>(0.98 * way) * kHalf_m[i]; };
    const core::SpaceVector hand = {along(0, std::cos(turn)), along(1, 0.9 * std::sin(turn)),
                                    along(2, 0.436 * std::sin(turn))};
    core::SpaceVector nearest;
    if (!core::nearest_on(core::SceneLayerKind::quadric, table, hand, at, nearest)) worst = 1;
    at = nearest;
    const double squares[3] = {double{at.x} * double{at.x}, double{at.y} * double{at.y},
                               double{at.z} * double{at.z}};
    worst = std::max(worst, std::abs(double{table.form[0]} * squares[0] + double{table.form[1]} * squares[1] +
                                     double{table.form[2]} * squares[2] - 1));
    return at.x;
  });
  state.counters["worst_value"] = worst;
}
BENCHMARK(SceneNearestOnEllipsoid);

}  // namespace
}  // namespace tacto::playback
