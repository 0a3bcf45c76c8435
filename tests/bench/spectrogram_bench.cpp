// SPDX-License-Identifier: GPL-3.0-or-later
// Spectrograms of a minute's 60 strokes: 40,000 samples each, window 10,000, hop 100, padded to 16,384;
// 18,060 rows. Compared with the transforms alone: two real frames per FFTW transform, single precision.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <vector>

#include "spatial/dsp/fourier/packed_fft.hpp"
#include "spatial/spectrogram/spectrogram_maker.hpp"
#include "tests/bench/workload.hpp"

namespace tacto::spatial {
namespace {

using schema::Texture;

constexpr std::size_t kStrokes = 60, kSamples = 40000, kRowsPerStroke = 301;
constexpr std::size_t kPadded = 16384;

// The workload's force against its exact position, drift and noise included.
std::vector<Texture> textures() {
  std::vector<Texture> all(kStrokes);
  std::size_t count = 0;
  for (Texture& texture : all) {
    texture.signal.pitch_m = bench::kPitch_m;
    for (std::size_t i = 0; i < kSamples; ++i, ++count) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(i) * 1e-3;
      texture.signal.values.push_back(0.3 + 1e-6 * static_cast<double>(i) + 0.05 * std::sin(2 * turn) +
                                      0.02 * std::sin(8 * turn) + 0.005 * (bench::hashed(count) - 0.5));
    }
  }
  return all;
}

void packed_fftw_float(benchmark::State& state) {
  constexpr std::size_t kTransforms = kStrokes * (kRowsPerStroke + 1) / 2;
  PackedFft<float> fft(kPadded, kTransforms);
  for (std::size_t i = 0; i < 10000; ++i) fft.input()[i] = static_cast<float>(bench::hashed(i));
  for (auto _ : state)
    for (std::size_t i = 0; i < kTransforms; ++i) {
      fft.transform();
      benchmark::DoNotOptimize(fft.output().data());
    }
}

void make_all(benchmark::State& state, double max_frequency_per_m) {
  const auto all = textures();
  SpectrogramOptions options;
  options.max_frequency_per_m = max_frequency_per_m;
  auto maker = SpectrogramMaker::prepare(options, bench::kPitch_m, kStrokes * kRowsPerStroke);
  if (!maker) return state.SkipWithError("not prepared");
  for (auto _ : state)
    for (const Texture& texture : all) {
      const auto made = maker->make(texture, [](std::size_t, std::span<const float> cells) {
        benchmark::DoNotOptimize(cells.data());
        return schema::Result<void>{};
      });
      if (!made) return state.SkipWithError("not made");
    }
}

void spectrogram_all_bins(benchmark::State& state) {
  make_all(state, 500e3);
}

void spectrogram_to_15_per_mm(benchmark::State& state) {
  make_all(state, 15e3);
}

BENCHMARK(packed_fftw_float)->Unit(benchmark::kMillisecond);
BENCHMARK(spectrogram_all_bins)->Unit(benchmark::kMillisecond);
BENCHMARK(spectrogram_to_15_per_mm)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tacto::spatial
