// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/text_columns.hpp"

#include <cassert>

#include "capture/table/csv_fields.hpp"
#include "capture/table/input_file.hpp"
#include "capture/table/text_encoding.hpp"

namespace tacto::capture {
namespace {

schema::Result<std::string> whole_text(const std::string& file) {
  auto input = InputFile::open(file);
  TACTO_TRY(input);
  std::string text, piece(std::size_t{1} << 16, '\0');
  for (;;) {
    const auto got = input->read(piece);
    TACTO_TRY(got);
    if (*got == 0) return text;
    text.append(piece, 0, *got);
  }
}

}  // namespace

schema::Result<std::vector<std::vector<std::string>>> read_texts(const Source& source,
                                                                 std::span<const std::size_t> columns) {
  assert(source.csv);
  const auto text = whole_text(source.file);
  TACTO_TRY(text);
  std::vector<std::vector<std::string>> texts(columns.size());
  for (std::size_t at = source.csv->data_offset; at < text->size();) {
    const std::size_t end = std::min(text->find(source.csv->line_end, at), text->size());
    const auto line = without_returns(std::string_view(*text).substr(at, end - at));
    at = end + 1;
    if (is_blank_line(line) || is_comment_line(line)) continue;
    const auto fields = fields_of(line, source.csv->delimiter);
    for (std::size_t k = 0; k < columns.size(); ++k)
      texts[k].push_back(columns[k] < fields.size() ? to_utf8(fields[columns[k]]) : "");
  }
  return texts;
}

}  // namespace tacto::capture
