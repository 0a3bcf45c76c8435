// SPDX-License-Identifier: GPL-3.0-or-later
// A tick in a volume of 256^3 values: a point at most 0.3 us, a tool of 1,000 points 20 us. The workload,
// which any program can repeat: values 0.5 mm apart that fall by 1000 per mm of the distance from the middle,
// 0 at 50 mm; a hand on a circle of 49 mm in a plane that turns, at 0.2 m/s, places in whole um, 1 kHz; the
// points of the tool even on a ball of 20 mm. Clay, its surface and a press: at most 0.2 us, kept 0.3, on
// 256^2 heights 1 mm apart, a point on a circle of 60 mm at 0.2 m/s. Each tick is timed alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "firmware-host/core/scene/clay.hpp"
#include "firmware-host/core/scene/volume.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/prepare/scene/volume_block.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kVolumeSide = 256;
constexpr double kVoxel_m = 5e-4, kCount_m = 1e-6, kCircle_m = 0.049, kToolBall_m = 0.02, kTickWay_m = 2e-4;

schema::Volume ball_of_values() {
  schema::Volume volume;
  volume.samples = {kVolumeSide, kVolumeSide, kVolumeSide};
  volume.spacing_m = {kVoxel_m, kVoxel_m, kVoxel_m};
  const auto at_m = [](std::size_t i) {
    return (static_cast<double>(i) - (kVolumeSide - 1) / 2.0) * kVoxel_m;
  };
  for (std::size_t z = 0; z < kVolumeSide; ++z)
    for (std::size_t y = 0; y < kVolumeSide; ++y)
      for (std::size_t x = 0; x < kVolumeSide; ++x)
        volume.stored.push_back(static_cast<std::int16_t>(
            std::clamp(1e6 * (0.05 - std::hypot(at_m(x), at_m(y), at_m(z))), -32000.0, 32000.0)));
  return volume;
}

std::vector<std::array<double, 3>> ball_of_points(std::size_t count) {
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i < count && count > 1; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count),
                 r = std::sqrt(1 - z * z),
                 turn = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
    points.push_back({kToolBall_m * r * std::cos(turn), kToolBall_m * r * std::sin(turn), kToolBall_m * z});
  }
  return points;
}

void TouchVolume(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  static const schema::Volume volume = ball_of_values();
  schema::Piece piece;
  piece.value_per_m = 1e6;
  auto words = volume_table(piece, volume, core::PieceTable{}, {kCount_m, kCount_m, 1e-3, kCount_m},
                            ball_of_points(static_cast<std::size_t>(state.range(0))));
  auto& table = *reinterpret_cast<core::VolumeTable*>(words.data());
  std::vector<double> ticks_ns;
  double tick = 0;
  for (auto _ : state) {
    const double turn = kTickWay_m / kCircle_m * ++tick, tilt = 0.0113 * turn;
    const double way[3] = {std::cos(turn), std::sin(turn) * std::cos(tilt), std::sin(turn) * std::sin(tilt)};
    std::int32_t counts[3];
    for (int i = 0; i < 3; ++i)
      counts[i] = static_cast<std::int32_t>(std::lround(kCircle_m * way[i] / kCount_m));
    const auto begin = Clock::now();
    core::VolumeTouch touch = core::touch_volume(table, counts, 1);
    benchmark::DoNotOptimize(touch);
    ticks_ns.push_back(std::chrono::duration<double, std::nano>(Clock::now() - begin).count());
  }
  std::ranges::sort(ticks_ns);
  state.counters["median_ns"] = ticks_ns[ticks_ns.size() / 2];
  state.counters["p99_ns"] = ticks_ns[ticks_ns.size() * 99 / 100];
}
// `state.range(0)`: its volume is kept.
void PressClay(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kClaySide = 256;
  constexpr double kRing_m = 0.06, kGrid_m = 1e-3;
  Relief flat{kClaySide, kClaySide, kGrid_m, 0, 0};
  flat.levels.push_back({kClaySide, kClaySide, std::vector<float>(kClaySide * kClaySide)});
  core::ReliefPieceTable head;
  head.piece.form[core::kPieceDirection + 2] = 1;
  head.clay = {1, 0x1p-21F, -0x1p-6F, 0x1p-6F, static_cast<std::uint32_t>(state.range(0))};
  const std::vector<std::uint32_t> map = relief_table(flat, 0, {}, {0, 0});
  std::vector<std::uint32_t> words(sizeof head / sizeof(std::uint32_t));
  std::memcpy(words.data(), &head, sizeof head);
  words.insert(words.end(), map.begin(), map.end());
  auto& table = *reinterpret_cast<core::ReliefPieceTable*>(words.data());
  std::vector<double> ticks_ns;
  double tick = 0;
  for (auto _ : state) {
    const double turn = kTickWay_m / kRing_m * ++tick, radius_m = kRing_m * (1 - 1e-6 * tick);
    const core::SpaceVector place = {static_cast<float>(radius_m * std::cos(turn)),
                                     static_cast<float>(radius_m * std::sin(turn)), 0};
    const auto begin = Clock::now();
    core::PieceSurface at = core::relief_surface_at(table, place);
    benchmark::DoNotOptimize(at);
    core::press_clay(table, place);
    ticks_ns.push_back(std::chrono::duration<double, std::nano>(Clock::now() - begin).count());
  }
  std::ranges::sort(ticks_ns);
  state.counters["median_ns"] = ticks_ns[ticks_ns.size() / 2];
  state.counters["p99_ns"] = ticks_ns[ticks_ns.size() * 99 / 100];
}
BENCHMARK(PressClay)->Arg(0)->Iterations(200'000);
BENCHMARK(PressClay)->Arg(1)->Iterations(200'000);
BENCHMARK(TouchVolume)->Arg(1)->Iterations(200'000);
BENCHMARK(TouchVolume)->Arg(1000)->Iterations(20'000);

}  // namespace
}  // namespace tacto::playback
