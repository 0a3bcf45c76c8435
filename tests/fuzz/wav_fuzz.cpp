// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a WAV: read as a whole, repaired, and read as the recording that recovery makes from it.
#include "data-schema/wav/riff_layout.hpp"
#include "data-schema/wav/riff_repair.hpp"
#include "data-schema/wav/wav.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace tacto;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = tests::fuzzed_file("x.wav", data, size);
  if (const auto first = schema::read_wav_channel(path, 0)) tests::demand(first->size() <= 8 * size);
  const bool has_layout = schema::riff_layout(path).has_value();
  const auto repaired = schema::repair_riff(path);
  if (repaired) tests::demand(has_layout && *repaired <= size);
  tests::demand(std::filesystem::file_size(path) <= size);
  (void)schema::read_wav_channel(path, 1);
  return 0;
}
