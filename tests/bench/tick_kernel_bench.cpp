// SPDX-License-Identifier: GPL-3.0-or-later
// A tick: position between counts, two levels of the pyramid by Hermite, gain, eight sections or taps,
// limits. Batches of 1000 ticks of a finger at 0.1 m/s; and single ticks after a sleep, during which other
// programs use the cache.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {
namespace {

constexpr double kTickRateHz = 10e3;
constexpr int kTicks = 1000;

schema::Texture bench_texture() {
  schema::Texture texture;
  texture.signal.pitch_m = 1e-6;
  for (int i = 0; i < 60000; ++i) {
    double force_n = 0;
    for (const double per_m : {330.0, 2670.0, 11e3, 31e3})
      force_n += 0.01 * std::sin(2 * std::numbers::pi * per_m * i * 1e-6);
    texture.signal.values.push_back(force_n);
  }
  return texture;
}

Prepared bench_prepared(Inverse inverse) {
  PrepareOptions options;
  options.rate_hz = kTickRateHz;
  options.ends = Ends::loop;
  options.inverse = inverse;
  options.energy_rms_v = 3;
  return *prepare(bench_texture(), *schema::read_transducer("wiertlewski2011"), options);
}

/// Eight sections of an actuator's inverse filter.
std::vector<wire::Section> eight_sections() {
  return std::vector<wire::Section>(8, wire::Section{1.05F, -1.92F, 0.95F, -1.9F, 0.95F});
}

void tick_batches(benchmark::State& state, const core::KernelSetup& setup) {
  core::TickKernel kernel;
  kernel.set(setup);
  std::int32_t count = 0;
  for (auto _ : state) {
    float sum = 0;
    for (int i = 0; i < kTicks; ++i) sum += kernel.tick({count += 10, 1e-3F, true, core::kNoForce}).drive_v;
    benchmark::DoNotOptimize(sum);
  }
  state.counters["ns_per_tick"] = benchmark::Counter(
      kTicks * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// A chain of sections that rings out after full scale: denormals would make a tick 10 to 100 times slower on
/// processors that trap them.
void section_chain(benchmark::State& state, float input) {
  const auto sections = eight_sections();
  core::SectionChain chain;
  chain.set(sections.data(), static_cast<std::uint8_t>(sections.size()));
  for (int i = 0; i < 200000; ++i) (void)chain.filter(5 * std::sin(0.03F * static_cast<float>(i)));
  for (int i = 0; i < 200000; ++i) (void)chain.filter(input);
  for (auto _ : state) {
    float sum = 0;
    for (int i = 0; i < kTicks; ++i) sum += chain.filter(input);
    benchmark::DoNotOptimize(sum);
  }
}
BENCHMARK_CAPTURE(section_chain, silence, 0.0F)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(section_chain, full_scale, 5.0F)->Unit(benchmark::kMicrosecond);

void texture_tick_sections(benchmark::State& state) {
  const Prepared prepared = bench_prepared(Inverse::gain);
  const auto sections = eight_sections();
  core::KernelSetup setup = prepared.setup();
  setup.tap_count = 0;
  setup.sections = sections.data();
  setup.section_count = static_cast<std::uint8_t>(sections.size());
  tick_batches(state, setup);
}
BENCHMARK(texture_tick_sections)->Unit(benchmark::kMicrosecond);

void texture_tick_taps(benchmark::State& state) {
  const Prepared prepared = bench_prepared(Inverse::full);
  tick_batches(state, prepared.setup());
}
BENCHMARK(texture_tick_taps)->Unit(benchmark::kMicrosecond);

/// Reads 8 MB between ticks, so that the cache is cold as after a sleep.
void texture_tick_cold(benchmark::State& state) {
  const Prepared prepared = bench_prepared(Inverse::full);
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  std::vector<char> others(8U << 20U);
  std::vector<double> times_ns;
  std::int32_t count = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < others.size(); i += 64) ++others[i];
    const auto before = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(kernel.tick({count += 10, 1e-3F, true, core::kNoForce}));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
    times_ns.push_back(1e9 * took.count());
    state.SetIterationTime(took.count());
  }
  std::ranges::sort(times_ns);
  state.counters["p50_ns"] = times_ns[times_ns.size() / 2];
  state.counters["p99_ns"] = times_ns[times_ns.size() * 99 / 100];
}
BENCHMARK(texture_tick_cold)->UseManualTime()->Iterations(2000)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace tacto::playback
