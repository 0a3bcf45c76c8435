// SPDX-License-Identifier: GPL-3.0-or-later
// Butterworth band-pass of order 4, forwards and backwards, over 600,000 samples.
#include <benchmark/benchmark.h>

#include <vector>

#include "spatial/dsp/filter/butterworth.hpp"
#include "spatial/dsp/filter/sections.hpp"
#include "tests/bench/workload.hpp"

namespace tacto::spatial {
namespace {

void zero_phase_sos(benchmark::State& state) {
  const std::vector<double> force = bench::workload(60).force_n;
  const auto sections = butterworth_band_pass(4, {15, 500}, bench::kRate_hz);
  for (auto _ : state)
    benchmark::DoNotOptimize(filter_zero_phase(*sections, force, default_padding(*sections)).data());
}
BENCHMARK(zero_phase_sos)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tacto::spatial
