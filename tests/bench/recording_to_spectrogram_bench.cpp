// SPDX-License-Identifier: GPL-3.0-or-later
// The whole chain: a minute's recording on disk is opened, filtered, its 60 strokes become textures in
// memory, their spectrograms up to 15 /mm are written as netCDF. Also the last step alone, and a short
// recording, of which a folder may contain many.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/spectrogram/spectrogram_writer.hpp"
#include "spatial/spectrogram/spectrogram_maker.hpp"
#include "spatial/texture/make_texture.hpp"
#include "tests/bench/workload.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::spatial {
namespace {

using schema::Result;

constexpr std::size_t kSeconds = 60, kRows = 60 * 301;

schema::Channel channel(const char* name, const char* unit) {
  schema::Channel made;
  made.name = made.quantity = name;
  made.unit = unit;
  return made;
}

Result<schema::Recording> written(const std::string& stem, std::size_t seconds) {
  schema::RecordingHeader header;
  header.sample_rate_hz = bench::kRate_hz;
  header.clock = "nominal rate of the workload";
  header.channels = {channel("tangential_force", "N"), channel("position", "m")};
  const auto [position_m, force_n] = bench::workload(seconds);
  std::vector<double> frames;
  for (std::size_t i = 0; i < position_m.size(); ++i) {
    frames.push_back(force_n[i]);
    frames.push_back(position_m[i]);
  }
  auto writer = schema::RecordingWriter::create(stem, header);
  TACTO_TRY(writer);
  TACTO_TRY(writer->write(std::span<const double>(frames)));
  return writer->close();
}

// The work of the verb without its report.
Result<void> to_spectrogram(const std::string& stem, const std::string& path) {
  const auto recording = schema::open_recording(stem);
  TACTO_TRY(recording);
  auto textures = TextureMaker::open(*recording, {});
  TACTO_TRY(textures);
  auto maker = SpectrogramMaker::prepare({}, bench::kPitch_m, kRows);
  TACTO_TRY(maker);
  schema::PendingFiles files;
  const auto temporary = files.add(path);
  auto writer = schema::open_spectrogram_nc(*temporary, {.several = true, .named = path});
  int number = 0;
  for (const Stroke& stroke : textures->record().strokes()) {
    const auto texture = textures->make(stroke, ++number);
    TACTO_TRY(texture);
    const auto header = maker->describe(*texture);
    TACTO_TRY(header);
    if (auto begun = (*writer)->begin(*header); !begun) return begun;
    const auto made = maker->make(*texture, [&](std::size_t first, std::span<const float> cells) {
      return (*writer)->rows(first, cells);
    });
    if (!made) return made;
  }
  if (auto closed = (*writer)->close(); !closed) return closed;
  return files.commit();
}

void recording_to_spectrogram(benchmark::State& state) {
  const tests::TemporaryFolder folder;
  const std::string stem = folder / "minute", path = folder / "minute.nc";
  if (!written(stem, kSeconds)) return state.SkipWithError("no recording");
  for (auto _ : state)
    if (const auto done = to_spectrogram(stem, path); !done)
      return state.SkipWithError(schema::message(done.error()).c_str());
}

// One of many recordings in a folder, 2 s each: opened and checked, its two strokes become textures and are
// written.
void short_recording_to_textures(benchmark::State& state) {
  const tests::TemporaryFolder folder;
  if (!written(folder / "two", 2)) return state.SkipWithError("no recording");
  for (auto _ : state) {
    const auto recording = schema::open_recording(folder / "two");
    if (!recording || !schema::check_samples_sum(*recording)) return state.SkipWithError("not opened");
    auto textures = TextureMaker::open(*recording, {});
    if (!textures) return state.SkipWithError(schema::message(textures.error()).c_str());
    schema::PendingFiles files;
    int number = 0;
    for (const Stroke& stroke : textures->record().strokes()) {
      const auto texture = textures->make(stroke, ++number);
      if (!texture || !schema::add_texture(files, folder / std::to_string(number), *texture))
        return state.SkipWithError("no texture");
    }
    if (!files.commit()) return state.SkipWithError("not written");
  }
}

// 60 strokes of 301 rows and 246 bins.
void spectrogram_written(benchmark::State& state) {
  const tests::TemporaryFolder folder;
  schema::Spectrogram one;
  one.bins = 246;
  one.unit = "N";
  one.frequency_step_per_m = 1e6 / 16384;
  for (int p = 0; p < 301; ++p) {
    one.position_m.push_back(5e-3 + 1e-4 * p);
    one.known.push_back({300, 10000});
    for (std::size_t k = 0; k < one.bins; ++k)
      one.cells.push_back(static_cast<float>(bench::hashed(one.cells.size())));
  }
  const std::vector<schema::Spectrogram> all(60, one);
  for (auto _ : state)
    if (!schema::write_spectrogram_nc(folder / "all.nc", all)) return state.SkipWithError("not written");
}

BENCHMARK(recording_to_spectrogram)->Unit(benchmark::kMillisecond);
BENCHMARK(short_recording_to_textures)->Unit(benchmark::kMillisecond);
BENCHMARK(spectrogram_written)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tacto::spatial
