// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/audio_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/wav/wav.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::size_t kPieceSamples = 65536;

tl::unexpected<schema::Error> not_finite(const Source& source, std::uint64_t frame, std::size_t column,
                                         double value) {
  return fail(ErrorKind::malformed, std::isnan(value) ? "is NaN" : "is infinite",
              fmt::format("{}: sample {}, {}", source.file, frame, column_in_words(source.columns, column)),
              "import the part without it: unknown values are not filled in");
}

// Appends the chosen columns of a piece whose first frame is `first`.
Result<void> choose(const Source& source, std::span<const std::size_t> columns, std::uint64_t first,
                    std::span<const double> piece, std::vector<double>& rows) {
  const std::size_t channels = source.columns.size();
  rows.clear();
  for (std::size_t i = 0; i < piece.size(); i += channels)
    for (const std::size_t column : columns) {
      const double value = piece[i + column];
      if (!std::isfinite(value)) return not_finite(source, first + i / channels, column, value);
      rows.push_back(value);
    }
  return {};
}

}  // namespace

Result<Source> open_audio(const std::string& file) {
  const auto reader = schema::WavReader::open(file);
  if (!reader) {
    schema::Error error = reader.error();
    if (error.remedy.empty())
      error.remedy = "import reads tables (CSV) and the formats of libsndfile (WAV, FLAC, OGG ...)";
    return tl::unexpected(error);
  }
  const schema::WavInfo& info = reader->info();
  if (info.frames == 0) return fail(ErrorKind::malformed, "contains no samples", file);
  Source source{file, {}, std::nullopt, info.sample_rate_hz, info.code_bits, info.format};
  for (std::size_t i = 0; i < info.channels; ++i) source.columns.push_back(fmt::format("ch{}", i + 1));
  return source;
}

Result<void> read_audio(const Source& source, std::span<const std::size_t> columns, const RowHandler& take,
                        const std::function<void(double)>& progress) {
  auto reader = schema::WavReader::open(source.file);
  TACTO_TRY(reader);
  const std::size_t channels = source.columns.size();
  std::vector<double> piece(std::max<std::size_t>(kPieceSamples / channels, 1) * channels), rows;
  for (std::uint64_t done = 0;;) {
    const auto got = reader->read(std::span(piece));
    TACTO_TRY(got);
    if (*got == 0 && done == 0) return fail(ErrorKind::malformed, "contains no samples", source.file);
    if (*got == 0) return {};
    const auto chosen = choose(source, columns, done, std::span(piece).first(*got * channels), rows);
    if (!chosen) return chosen;
    if (const auto taken = take({rows, columns.size(), done}); !taken) return taken;
    done += *got;
    progress(static_cast<double>(done) / static_cast<double>(std::max(reader->info().frames, done)));
  }
}

}  // namespace tacto::capture
