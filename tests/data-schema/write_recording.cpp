// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the recordings FOLDER/codes and FOLDER/numbers for recording_wav_test.py, which contains the
// expected values.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "data-schema/recording/recording.hpp"

namespace {

using namespace tacto::schema;

constexpr std::size_t kFrames = 1000;

RecordingHeader header_for(SampleFormat format) {
  RecordingHeader header;
  header.format = format;
  header.sample_rate_hz = 10000;
  for (const char* name : {"tangential_force", "position", "drive"}) {
    const QuantityName quantity = quantity_named(name).value();
    header.channels.push_back({});
    header.channels.back().name = header.channels.back().quantity = name;
    header.channels.back().unit = si_symbol(quantity.dimension);
  }
  return header;
}

template <class Sample>
Result<Recording> write(const std::string& name, SampleFormat format, const std::vector<Sample>& samples) {
  auto writer = RecordingWriter::create(name, header_for(format));
  TACTO_TRY(writer);
  TACTO_TRY(writer->write(std::span<const Sample>(samples)));
  return writer->close();
}

Result<Recording> write_both(const std::string& folder) {
  std::vector<std::int32_t> codes;
  std::vector<double> numbers;
  for (std::size_t i = 0; i < 3 * kFrames; ++i) {
    codes.push_back(static_cast<std::int32_t>(static_cast<std::uint32_t>(i) * 2654435761U));
    numbers.push_back(std::ldexp(static_cast<double>(codes.back()), -40));
  }
  const auto first = write(folder + "/codes", SampleFormat::pcm32, codes);
  return first ? write(folder + "/numbers", SampleFormat::float64, numbers) : first;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto done = write_both(argv[1]);
  if (!done) std::fprintf(stderr, "%s\n", message(done.error()).c_str());
  return done ? 0 : 1;
}
