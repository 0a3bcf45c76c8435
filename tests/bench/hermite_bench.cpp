// SPDX-License-Identifier: GPL-3.0-or-later
// Force to space: 60 s at 10 kHz, one 40 mm stroke a second at 50 mm/s, an encoder of 1 um, a grid of 1 um.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "spatial/monotone_path.hpp"
#include "spatial/resample.hpp"

namespace tacto::spatial {
namespace {

constexpr double kRate_hz = 10000;
constexpr double kQuantum_m = 1e-6;
constexpr int kStrokes = 60;
constexpr std::size_t kStrokeFrames = 8000;  // 40 mm at 50 mm/s

struct Stroked {
  std::vector<double> position_m, force_n;
};

// A finger whose speed wavers by a tenth; forces of 100 to 400 Hz.
Stroked stroke() {
  Stroked made;
  for (std::size_t i = 0; i < kStrokeFrames; ++i) {
    const double t_s = static_cast<double>(i) / kRate_hz;
    const double turn = 2 * std::numbers::pi * t_s;
    const double exact_m = 0.05 * (t_s + 0.1 * std::sin(5 * turn) / (10 * std::numbers::pi));
    made.position_m.push_back(std::round(exact_m / kQuantum_m) * kQuantum_m);
    made.force_n.push_back(std::sin(100 * turn) + 0.3 * std::sin(400 * turn));
  }
  return made;
}

void hermite_to_space(benchmark::State& state) {
  const Stroked stroked = stroke();
  std::size_t samples = 0;
  for (auto _ : state)
    for (int i = 0; i < kStrokes; ++i) {
      const MonotonePath path = monotone_path(stroked.position_m, 1, {kQuantum_m, 0});
      const auto grid = grid_along(path, 1, 1e-6);
      const auto values = resample(path, 1, *grid, stroked.force_n, 0);
      benchmark::DoNotOptimize(values.data());
      samples += values.size();
    }
  state.counters["samples"] = benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}
BENCHMARK(hermite_to_space)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tacto::spatial
