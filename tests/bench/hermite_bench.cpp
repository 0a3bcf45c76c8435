// SPDX-License-Identifier: GPL-3.0-or-later
// 60 s of strokes to space: 60 strokes of 40 mm on a grid of 1 um, 2.4 million values.
#include <benchmark/benchmark.h>

#include <vector>

#include "spatial/strokes/monotone_path.hpp"
#include "spatial/texture/resample.hpp"
#include "tests/bench/workload.hpp"

namespace tacto::spatial {
namespace {

constexpr std::size_t kStrokes = 60;

struct Stroked {
  MonotonePath path;
  int direction;
  SpaceGrid grid;
  std::span<const double> force_n;
};

int direction_of(std::size_t stroke) {
  return stroke % 2 == 0 ? 1 : -1;
}

MonotonePath path_of(const bench::Workload& work, std::size_t stroke) {
  const auto frames =
      std::span(work.position_m).subspan(stroke * bench::kFramesPerSecond, bench::kStrokeFrames);
  return monotone_path(frames, direction_of(stroke), {bench::kQuantum_m, 0});
}

std::vector<Stroked> strokes_of(const bench::Workload& work) {
  std::vector<Stroked> strokes;
  for (std::size_t i = 0; i < kStrokes; ++i) {
    MonotonePath path = path_of(work, i);
    const SpaceGrid grid = *grid_along(path, direction_of(i), bench::kPitch_m);
    const auto force = std::span(work.force_n).subspan(i * bench::kFramesPerSecond, bench::kStrokeFrames);
    strokes.push_back({std::move(path), direction_of(i), grid, force});
  }
  return strokes;
}

void take_to_space(benchmark::State& state, ResampleMethod method) {
  const auto work = bench::workload(kStrokes);
  const auto strokes = strokes_of(work);
  Resampler resampler(method);
  std::vector<double> values;
  std::size_t samples = 0;
  for (auto _ : state)
    for (const auto& [path, direction, grid, force_n] : strokes) {
      values.resize(grid.count);
      resampler(path, direction, grid, force_n, 0, values);
      benchmark::DoNotOptimize(values.data());
      samples += values.size();
    }
  state.counters["samples"] = benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}

void pchip_true_inverse(benchmark::State& state) {
  take_to_space(state, ResampleMethod::hermite);
}
BENCHMARK(pchip_true_inverse)->Unit(benchmark::kMillisecond);

void resample_sinc(benchmark::State& state) {
  take_to_space(state, ResampleMethod::sinc);
}
BENCHMARK(resample_sinc)->Unit(benchmark::kMillisecond);

void monotone_paths(benchmark::State& state) {
  const auto work = bench::workload(kStrokes);
  for (auto _ : state)
    for (std::size_t i = 0; i < kStrokes; ++i) benchmark::DoNotOptimize(path_of(work, i).way_m.data());
}
BENCHMARK(monotone_paths)->Name("monotone_path")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tacto::spatial
