// SPDX-License-Identifier: GPL-3.0-or-later
// Import of a table of 60 s: the whole import, and its parts.
#include <benchmark/benchmark.h>

#include "capture/import/import.hpp"
#include "capture/table/source.hpp"
#include "data-schema/files/files.hpp"
#include "tests/bench/workload_csv.hpp"

namespace tacto::capture {
namespace {

ImportRequest request() {
  ImportRequest made;
  made.file = bench::workload_csv_file();
  made.name = (std::filesystem::temp_directory_path() / "tacto-bench-imported").string();
  made.replace = true;
  made.time_column = "time_s*1s";
  made.channels = {"tangential_force=force_V*1N", "position=count*1um"};
  return made;
}

void import_csv(benchmark::State& state) {
  const ImportRequest asked = request();
  for (auto _ : state)
    if (const auto done = import_file(asked, [](double) {}); !done)
      state.SkipWithError(schema::message(done.error()).c_str());
}
BENCHMARK(import_csv)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void parse_csv(benchmark::State& state) {
  const auto source = open_source(bench::workload_csv_file());
  const std::vector<std::size_t> columns = {0, 1, 2};
  const auto take = [](const RowBlock& block) {
    benchmark::DoNotOptimize(block.numbers.data());
    return schema::Result<void>{};
  };
  for (auto _ : state)
    if (const auto read = read_source(*source, columns, take, [](double) {}); !read)
      state.SkipWithError(schema::message(read.error()).c_str());
}
BENCHMARK(parse_csv)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

// Cost of the checksums in import_csv: of the source and of the WAV.
void import_checksums(benchmark::State& state) {
  const auto recording = import_file(request(), [](double) {});
  const std::string wav = recording->recording.stem + ".wav", csv = request().file;
  for (auto _ : state) {
    benchmark::DoNotOptimize(schema::sha256_of_file(csv));
    benchmark::DoNotOptimize(schema::sha256_of_file(wav));
  }
}
BENCHMARK(import_checksums)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tacto::capture
