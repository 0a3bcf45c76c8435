// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/scene/number_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of UTF-8; spreadsheets write it

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    cells.push_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  return cells;
}

std::optional<double> finite_number(std::string_view cell) {
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') cell.remove_prefix(1);  // from_chars() refuses it
  double value = 0;
  const auto [end, failed] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool whole = failed == std::errc() && end == cell.data() + cell.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Reads the lines of one file, from the first to the last.
class RowReader {
 public:
  RowReader(const std::string& path, const RowsAsked& asked) : path_(path), asked_(asked) {}

  Result<NumberRows> read(std::string_view text) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      ++line_;
      TACTO_TRY(take(trimmed(text.substr(at, end - at))));
      at = end + 1;
    }
    if (rows_.lines.empty())
      return fault(fmt::format("it has no {}s", asked_.row), "the first line names the columns");
    return std::move(rows_);
  }

 private:
  tl::unexpected<Error> fault(std::string what, std::string remedy) const {
    return fault_in_line(path_, std::max<std::size_t>(line_, 1), std::move(what), std::move(remedy));
  }

  Result<void> take(std::string_view line) {
    if (line.empty() || line.front() == '#') return {};
    return places_.empty() ? take_header(cells_of(line)) : take_row(cells_of(line));
  }

  Result<void> take_header(const std::vector<std::string_view>& cells) {
    for (const std::string_view cell : cells) TACTO_TRY(take_column(cell));
    for (std::size_t i = 0; i < asked_.columns.size(); ++i)
      if (std::ranges::count(places_, i) == 0)
        return fault(fmt::format("the column {} is missing", asked_.columns[i]), names());
    return {};
  }

  Result<void> take_column(std::string_view cell) {
    const auto known = std::ranges::find(asked_.columns, cell);
    if (known == asked_.columns.end()) return unknown_column(std::string(cell.substr(0, 64)));
    const auto place = static_cast<std::size_t>(known - asked_.columns.begin());
    if (std::ranges::count(places_, place) > 0)
      return fault(fmt::format("the column {} appears twice", *known), "keep one of the two");
    places_.push_back(place);
    return {};
  }

  tl::unexpected<Error> unknown_column(const std::string& cell) const {
    const std::vector<std::string> known(asked_.columns.begin(), asked_.columns.end());
    const std::string nearest = nearest_word(cell, known);
    return fault(fmt::format("the column '{}' is not known", cell),
                 nearest.empty() ? names() : fmt::format("did you mean '{}'?", nearest));
  }

  std::string names() const { return fmt::format("the columns are {}", fmt::join(asked_.columns, ", ")); }

  Result<void> take_row(const std::vector<std::string_view>& cells) {
    if (cells.size() != places_.size())
      return fault(fmt::format("it has {} cells, the header has {}", cells.size(), places_.size()),
                   "separate the cells by commas");
    if (rows_.lines.size() == asked_.most_rows)
      return fault(fmt::format("it has more than {} {}s", asked_.most_rows, asked_.row),
                   "take a part of them");
    const std::size_t first = rows_.cells.size();
    rows_.cells.resize(first + cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = finite_number(cells[i]);
      if (!value) return fault(fmt::format("'{}' is no finite number", cells[i].substr(0, 64)), "correct it");
      rows_.cells[first + places_[i]] = *value;
    }
    rows_.lines.push_back(line_);
    return {};
  }

  const std::string& path_;
  const RowsAsked& asked_;
  std::size_t line_ = 0;
  std::vector<std::size_t> places_;  // of the columns of the file among those asked for
  NumberRows rows_;
};

}  // namespace

tl::unexpected<Error> fault_in_line(const std::string& path, std::size_t line, std::string what,
                                    std::string remedy) {
  return fail(ErrorKind::malformed, std::move(what), fmt::format("{}, line {}", path, line),
              std::move(remedy));
}

Result<NumberRows> read_number_rows(const std::string& path, const RowsAsked& asked) {
  const auto text = read_file(path);
  TACTO_TRY(text);
  return RowReader(path, asked).read(*text);
}

}  // namespace tacto::schema
