// SPDX-License-Identifier: GPL-3.0-or-later
// Fourier band-pass of 60 s and 600 s at 10 kHz.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/dsp/filter/fourier_filter.hpp"
#include "tests/bench/workload.hpp"

namespace tacto::spatial {
namespace {

constexpr Band kBand{15, 500};
constexpr std::size_t kChunk = 65536;

std::vector<double> force_of(std::int64_t seconds) {
  return bench::workload(static_cast<std::size_t>(seconds)).force_n;
}

// With treatment of the ends, in blocks; the filter and its plans are reused, as in a recording with gaps.
void fourier_band_pass(benchmark::State& state) {
  const std::vector<double> force = force_of(state.range(0));
  BlockFourierFilter filter(bench::kRate_hz, kBand);
  std::vector<double> out;
  out.reserve(force.size());
  for (auto _ : state) {
    out.clear();
    for (std::size_t i = 0; i < force.size(); i += kChunk)
      filter.push(std::span(force).subspan(i, std::min(kChunk, force.size() - i)), out);
    filter.finish(out);
    benchmark::DoNotOptimize(out.data());
  }
}
BENCHMARK(fourier_band_pass)->Unit(benchmark::kMillisecond)->Arg(60)->Arg(600);

// The same, including the construction of the filter and its plans.
void fourier_band_pass_once(benchmark::State& state) {
  const std::vector<double> force = force_of(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(fourier_filter(force, bench::kRate_hz, kBand, Edges::treated).data());
}
BENCHMARK(fourier_band_pass_once)->Unit(benchmark::kMillisecond)->Arg(60);

// Plain truncation of the whole record.
void fourier_plain(benchmark::State& state) {
  const std::vector<double> force = force_of(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(fourier_filter(force, bench::kRate_hz, kBand, Edges::none).data());
}
BENCHMARK(fourier_plain)->Unit(benchmark::kMillisecond)->Arg(60)->Arg(600);

}  // namespace
}  // namespace tacto::spatial
