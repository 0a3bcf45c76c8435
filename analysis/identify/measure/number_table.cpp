// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/number_table.hpp"

#include <numeric>

#include "capture/table/csv_reader.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

Result<capture::CsvLayout> layout_of(const std::string& text, const std::string& path) {
  const auto head = std::string_view(text).substr(0, capture::kLayoutBytes);
  auto layout = capture::find_csv_layout(head, head.size() == text.size(), path);
  if (!layout || layout->header) return layout;
  return fail(ErrorKind::malformed, "the first line does not name the columns", path,
              "write for example frequency_hz,amplitude_um_per_v,phase_deg above the numbers");
}

}  // namespace

Result<std::vector<std::string>> table_names(const std::string& path) {
  const auto text = schema::read_file(path);
  TACTO_TRY(text);
  auto layout = layout_of(*text, path);
  TACTO_TRY(layout);
  return layout->columns;
}

Result<NumberTable> read_numbers(const std::string& path) {
  const auto text = schema::read_file(path);
  TACTO_TRY(text);
  const auto layout = layout_of(*text, path);
  TACTO_TRY(layout);
  std::vector<std::size_t> all(layout->columns.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  capture::CsvReader reader(*layout, all, path);
  auto read = reader.feed(std::string_view(*text).substr(layout->data_offset));
  if (read) read = reader.finish();
  TACTO_TRY(read);
  NumberTable table{layout->columns, {reader.rows().begin(), reader.rows().end()}, {}};
  for (std::size_t row = 0; row < table.rows(); ++row)
    table.lines.push_back(capture::line_of_row(reader.landmarks(), row));
  return table;
}

}  // namespace tacto::analysis
