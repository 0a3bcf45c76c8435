// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/source.hpp"

#include <fmt/format.h>

#include "capture/audio_source.hpp"
#include "capture/input_file.hpp"
#include "data-schema/recording.hpp"

namespace tacto::capture {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;

constexpr std::size_t kPieceBytes = std::size_t{1} << 17;  // with its numbers it stays in the cache

std::string table_format(const CsvLayout& layout) {
  const char* const delimiter = layout.delimiter == '\t'  ? "tab"
                                : layout.delimiter == ';' ? "semicolon"
                                                          : "comma";
  return fmt::format("table, {}, {} header", delimiter, layout.header ? "with" : "without");
}

Result<Source> open_table(const std::string& file, std::string_view head, bool whole) {
  auto layout = find_csv_layout(head, whole, file);
  if (!layout) return schema::forward_error(layout);
  return Source{file, layout->columns, *layout, std::nullopt, 0, table_format(*layout)};
}

// Sound files have zero bytes among their first, text has none; UTF-16 has both and is a table to be
// converted.
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
    return fail(Fault::unsuitable, "is JSON, not a table or a sound file", file,
                "a recording needs no import: see 'tactograph info'");
  if (file.ends_with(".texture.wav"))
    return fail(Fault::unsuitable, "is a texture already", file, "see 'tactograph info'");
  if (file.ends_with(".wav") && schema::open_recording(file))
    return fail(Fault::unsuitable, "is a recording already", file, "see 'tactograph info'");
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

Result<Source> open_source(const std::string& file) {
  auto input = InputFile::open(file);
  if (!input) return schema::forward_error(input);
  std::string head(kLayoutBytes, '\0');
  const auto got = input->read(head);
  if (!got) return schema::forward_error(got);
  const bool whole = *got < head.size();
  head.resize(*got);
  if (const auto foreign = refuse_own(file, head); !foreign) return schema::forward_error(foreign);
  return is_binary(head) ? open_audio(file) : open_table(file, head, whole);
}

namespace {

Result<void> hand_over(CsvReader& reader, std::size_t columns, const TakeRows& take) {
  if (reader.rows().empty()) return {};
  const auto taken =
      take({reader.rows(), columns, reader.first_row(), &reader.landmarks(), reader.decimal_mark()});
  reader.drop_rows();
  return taken;
}

Result<void> read_table(const Source& source, std::span<const std::size_t> columns, const TakeRows& take,
                        const std::function<void(double)>& progress, schema::Sha256* sum) {
  auto input = InputFile::open(source.file);
  if (!input) return schema::forward_error(input);
  CsvReader reader(*source.csv, {columns.begin(), columns.end()}, source.file);
  std::string piece(kPieceBytes, '\0');
  std::size_t skipped = source.csv->data_offset;
  for (std::size_t done = 0;;) {
    const auto got = input->read(piece);
    if (!got) return schema::forward_error(got);
    if (*got == 0) break;
    const std::string_view bytes = std::string_view(piece).substr(0, *got);
    if (sum != nullptr) sum->add(bytes);
    if (const auto fed = reader.feed(bytes.substr(std::min(skipped, bytes.size()))); !fed) return fed;
    if (const auto taken = hand_over(reader, columns.size(), take); !taken) return taken;
    skipped -= std::min(skipped, bytes.size());
    done += *got;
    progress(static_cast<double>(done) / static_cast<double>(std::max(input->size(), done)));
  }
  if (const auto ended = reader.finish(); !ended) return ended;
  return hand_over(reader, columns.size(), take);
}

// libsndfile reads the file itself, so its bytes are read once more for the sum.
Result<void> add_file(const std::string& file, schema::Sha256& sum) {
  auto input = InputFile::open(file);
  if (!input) return schema::forward_error(input);
  std::string piece(kPieceBytes, '\0');
  for (;;) {
    const auto got = input->read(piece);
    if (!got) return schema::forward_error(got);
    if (*got == 0) return {};
    sum.add(std::string_view(piece).substr(0, *got));
  }
}

}  // namespace

Result<void> read_source(const Source& source, std::span<const std::size_t> columns, const TakeRows& take,
                         const std::function<void(double)>& progress, schema::Sha256* sum) {
  if (source.csv) return read_table(source, columns, take, progress, sum);
  const auto read = read_audio(source, columns, take, progress);
  return read && sum != nullptr ? add_file(source.file, *sum) : read;
}

}  // namespace tacto::capture
