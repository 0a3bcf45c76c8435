// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/source.hpp"

#include <fmt/format.h>

#include "capture/table/audio_source.hpp"
#include "capture/table/foreign_format.hpp"
#include "capture/table/input_file.hpp"
#include "capture/table/table_stages.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::size_t kPieceBytes = std::size_t{1} << 17;  // fits into the cache with its numbers

std::string table_format(const CsvLayout& layout) {
  const char* const delimiter = layout.delimiter == '\t'  ? "tab"
                                : layout.delimiter == ';' ? "semicolon"
                                                          : "comma";
  std::string format = fmt::format("table, {}, {} header", delimiter, layout.header ? "with" : "without");
  if (layout.lines_before > 0 && layout.header) format += fmt::format(" in line {}", layout.header_line);
  if (layout.lines_before > 0 && !layout.header) format += fmt::format(", from line {}", layout.data_line);
  if (layout.lines_before > 0) format += " (lines before it ignored)";
  if (layout.units_line > 0) format += fmt::format(", units in line {}", layout.units_line);
  return format;
}

Result<Source> open_table(const std::string& file, std::string_view head, bool whole, std::size_t skip) {
  auto layout = find_csv_layout(head, whole, file, skip);
  TACTO_TRY(layout);
  return Source{file, layout->columns, *layout, std::nullopt, 0, table_format(*layout), layout->units};
}

Result<Source> open_sound(const std::string& file, std::size_t skip) {
  if (skip == 0) return open_audio(file);
  return fail(ErrorKind::usage, "has no lines to skip", file, "omit --skip: this is not a table");
}

// libsndfile reads the numbers of any MATLAB file as audio. Only its own files name the rate "samplerate".
Result<Source> open_foreign(const std::string& file, const ForeignFormat& format, std::string_view head) {
  if (format.may_be_sound && head.find("samplerate") != std::string_view::npos) return open_audio(file);
  return fail(ErrorKind::unsuitable, fmt::format("is {}, which import does not read", format.what), file,
              std::string(format.remedy));
}

// Audio files have zero bytes near the beginning, text has none; UTF-16 has them too and is a table that the
// user has to convert.
bool is_binary(std::string_view head) {
  const bool utf16 = head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF");
  return !utf16 && head.find('\0') != std::string_view::npos;
}

bool is_json(const std::string& file, std::string_view head) {
  const auto first = head.find_first_not_of(" \t\r\n");
  return file.ends_with(".json") || (first != std::string_view::npos && head[first] == '{');
}

Result<void> refuse_own(const std::string& file, std::string_view head) {
  if (is_json(file, head))
    return fail(ErrorKind::unsuitable, "is JSON, not a table or a sound file", file,
                "a recording needs no import: see 'tactograph info'");
  if (file.ends_with(".texture.wav"))
    return fail(ErrorKind::unsuitable, "is already a texture", file, "see 'tactograph info'");
  if (file.ends_with(".wav") && schema::open_recording(file))
    return fail(ErrorKind::unsuitable, "is already a recording", file, "see 'tactograph info'");
  return {};
}

}  // namespace

std::string RowBlock::place_of(std::uint64_t row) const {
  if (landmarks == nullptr) return fmt::format("sample {}", row);
  return fmt::format("line {}", line_of_row(*landmarks, row));
}

std::string columns_in_words(const std::vector<std::string>& columns) {
  std::string list;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", i + 1);
    if (!columns[i].empty()) list += fmt::format(" '{}'", columns[i]);
  }
  return list;
}

Result<Source> open_source(const std::string& file, std::size_t skip) {
  auto input = InputFile::open(file);
  TACTO_TRY(input);
  std::string head(kLayoutBytes, '\0');
  const auto got = input->read(head);
  TACTO_TRY(got);
  const bool whole = *got < head.size();
  head.resize(*got);
  TACTO_TRY(refuse_own(file, head));
  if (const auto foreign = foreign_format(file, head)) return open_foreign(file, *foreign, head);
  return is_binary(head) ? open_sound(file, skip) : open_table(file, head, whole, skip);
}

namespace {

// libsndfile reads the file itself, so its bytes are read once more for the sum.
Result<void> add_file(const std::string& file, schema::Sha256& sum) {
  auto input = InputFile::open(file);
  TACTO_TRY(input);
  std::string piece(kPieceBytes, '\0');
  for (;;) {
    const auto got = input->read(piece);
    TACTO_TRY(got);
    if (*got == 0) return {};
    sum.add(std::string_view(piece).substr(0, *got));
  }
}

}  // namespace

Result<void> read_source(const Source& source, std::span<const std::size_t> columns, const RowHandler& take,
                         const std::function<void(double)>& progress, schema::Sha256* sum) {
  if (source.csv) return TableStages(source, columns, sum).run(take, progress);
  const auto read = read_audio(source, columns, take, progress);
  return read && sum != nullptr ? add_file(source.file, *sum) : read;
}

}  // namespace tacto::capture
