// SPDX-License-Identifier: GPL-3.0-or-later
// A table in memory, read as import reads a file.
#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "capture/table/csv_layout.hpp"
#include "capture/table/csv_reader.hpp"

namespace tacto::capture {

struct ReadText {
  CsvLayout layout;
  std::vector<std::vector<double>> values;
  std::deque<CsvReader::Landmark> landmarks;
};

/// All columns, or those given, the bytes fed in pieces of `piece` bytes.
inline schema::Result<ReadText> read_text(std::string_view text, std::vector<std::size_t> columns = {},
                                          std::size_t piece = 1 << 20) {
  const auto layout = find_csv_layout(text, true, "t.csv");
  TACTO_TRY(layout);
  if (columns.empty()) {
    columns.resize(layout->columns.size());
    std::iota(columns.begin(), columns.end(), std::size_t{0});
  }
  CsvReader reader(*layout, columns, "t.csv");
  for (std::size_t at = layout->data_offset; at < text.size(); at += piece)
    TACTO_TRY(reader.feed(text.substr(at, piece)));
  TACTO_TRY(reader.finish());
  ReadText read{*layout, std::vector<std::vector<double>>(columns.size()), reader.landmarks()};
  for (std::size_t i = 0; i < reader.rows().size(); ++i)
    read.values[i % columns.size()].push_back(reader.rows()[i]);
  return read;
}

}  // namespace tacto::capture
