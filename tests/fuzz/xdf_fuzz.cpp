// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as an XDF file: its streams, and the samples of each. Samples are as many as were counted.
#include <numeric>

#include "data-schema/exchange/xdf_file.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace tacto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = tests::fuzzed_file("x.xdf", data, size);
  const auto contents = schema::xdf_contents(path);
  if (!contents) return 0;
  for (const schema::XdfStream& stream : contents->streams) {
    if (stream.is_text()) {
      const auto markers = schema::read_xdf_markers(path, stream);
      tests::demand(!markers || markers->size() == stream.samples);
      continue;
    }
    std::uint64_t samples = 0;
    std::vector<std::size_t> channels(stream.channels);
    std::iota(channels.begin(), channels.end(), std::size_t{0});
    const auto count = [&](std::span<const double> times_s,
                           std::span<const double> numbers) -> schema::Result<void> {
      tests::demand(numbers.size() == times_s.size() * stream.channels);
      samples += times_s.size();
      return {};
    };
    const auto read = schema::read_xdf(path, stream, channels, count, [](double) {});
    tests::demand(!read || samples == stream.samples);
  }
  return 0;
}
