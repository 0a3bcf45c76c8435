// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/csv_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

#include "capture/table/csv_fields.hpp"
#include "capture/table/plain_decimal.hpp"
#include "capture/table/text_encoding.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;

// The part of a field that a message contains: a damaged file can have a page of text in one field.
std::string shown(std::string_view field) {
  constexpr std::size_t kMost = 40;
  const std::string text = to_utf8(trimmed(field).substr(0, kMost));
  return trimmed(field).size() > kMost ? text + "..." : text;
}

std::string words_for(NumberFault fault, std::string_view field) {
  switch (fault) {
    case NumberFault::missing:
      return "has no value";
    case NumberFault::nan:
      return fmt::format("is NaN ('{}')", shown(field));
    case NumberFault::infinite:
      return fmt::format("is infinite ('{}')", shown(field));
    case NumberFault::too_large:
      return fmt::format("'{}' is too large for a number", shown(field));
    case NumberFault::mixed_marks:
      return fmt::format("'{}' has another decimal mark than the rows before", shown(field));
    default:
      return fmt::format("'{}' is not a number", shown(field));
  }
}

bool is_unknown(NumberFault fault) {
  return fault == NumberFault::nan || fault == NumberFault::infinite || fault == NumberFault::missing;
}

}  // namespace

std::string column_in_words(const std::vector<std::string>& names, std::size_t column) {
  if (names[column].empty()) return fmt::format("column {}", column + 1);
  return fmt::format("column {} ('{}')", column + 1, names[column]);
}

std::size_t line_of_row(const std::deque<CsvReader::Landmark>& landmarks, std::size_t row) {
  const auto after = std::ranges::upper_bound(landmarks, row, {}, &CsvReader::Landmark::row);
  assert(after != landmarks.begin());
  const auto& last = *(after - 1);
  return last.line + (row - last.row);
}

CsvReader::CsvReader(CsvLayout layout, const std::vector<std::size_t>& columns, std::string file)
    : layout_(std::move(layout)),
      file_(std::move(file)),
      places_(layout_.columns.size(), kSkipped),
      kept_(columns.size()),
      line_(layout_.data_line) {
  for (std::size_t k = 0; k < columns.size(); ++k) places_[columns[k]] = k;
}

Result<void> CsvReader::feed(std::string_view piece) {
  assert(!error_);
  if (piece.empty()) return {};
  if (!incomplete_line_.empty()) {
    const std::size_t end = std::min(piece.find(layout_.line_end), piece.size() - 1);
    incomplete_line_ += piece.substr(0, end + 1);
    piece.remove_prefix(std::min(end + 1, piece.size()));
    std::string_view whole = incomplete_line_;
    if (!take_lines(whole)) return tl::unexpected(*error_);
    incomplete_line_.erase(0, incomplete_line_.size() - whole.size());
  }
  if (!take_lines(piece)) return tl::unexpected(*error_);
  incomplete_line_ += piece;
  return {};
}

Result<void> CsvReader::finish() {
  if (!incomplete_line_.empty() && !take_line(incomplete_line_)) {
    if (rows_ > 0)
      error_->remedy = fmt::format(
          "the file ends in this line, as one that was cut short does: delete the line to import the {} rows "
          "before it",
          rows_);
    return tl::unexpected(*error_);
  }
  incomplete_line_.clear();
  if (rows_ == 0) return schema::fail(ErrorKind::malformed, "contains no row of numbers", file_);
  return {};
}

void CsvReader::exchange_rows(NumberStore& store) {
  std::swap(store, store_);
  drop_rows();
}

void CsvReader::drop_rows() {
  store_.count = 0;
  dropped_ = rows_;
  const std::size_t oldest = rows_ - std::min(rows_, kRowsRemembered);
  while (landmarks_.size() > 1 && landmarks_[1].row <= oldest) landmarks_.pop_front();
}

// Reads all complete lines and leaves the bytes after them.
bool CsvReader::take_lines(std::string_view& bytes) {
  for (;;) {
    const auto end = bytes.find(layout_.line_end);
    if (end == std::string_view::npos) return true;
    if (!take_line(bytes.substr(0, end))) return false;
    bytes.remove_prefix(end + 1);
  }
}

bool CsvReader::take_line(std::string_view line) {
  line = without_returns(line);
  if (!line.empty() && line[0] > '#') {  // most lines: a digit or a minus, neither blank nor comment
    if (!take_row(line)) return false;
  } else if (is_blank_line(line)) {
    if (blank_line_ == 0) blank_line_ = line_;
  } else if (!is_comment_line(line)) {
    if (!take_row(line)) return false;
  }
  ++line_;
  return true;
}

bool CsvReader::take_row(std::string_view line) {
  if (blank_line_ != 0 && rows_ > 0) return refuse_blank();
  make_room(kept_);
  std::size_t at = 0;
  for (std::size_t column = 0; column < places_.size(); ++column) {
    if (at > line.size()) return refuse_ragged(line);
    if (places_[column] == kSkipped) {
      at = field_end(line, at, layout_.delimiter);
    } else if (!take_number(line, at, column)) {
      return false;
    }
    ++at;  // skips the delimiter
  }
  if (at <= line.size()) return refuse_ragged(line);
  note_row();
  return true;
}

bool CsvReader::take_number(std::string_view line, std::size_t& at, std::size_t column) {
  double& value = store_.numbers[store_.count + places_[column]];
  if (decimal_mark_ != ',' && take_plain_number(line, at, value)) return true;
  const std::size_t end = field_end(line, at, layout_.delimiter);
  const std::string field = unquoted(line.substr(at, end - at));
  const NumberFault fault = read_number(field, decimal_mark_, value);
  if (is_unknown(fault) && layout_.unknown_as_nan) {
    value = std::nan("");
  } else if (fault != NumberFault::none) {
    return refuse_number(fault, line, field, column);
  }
  at = end;
  return true;
}

// The fast path for the common case: a plain number directly before its delimiter.
bool CsvReader::take_plain_number(std::string_view line, std::size_t& at, double& value) {
  const char* const begin = line.data() + at;
  const char* const end = line.data() + line.size();
  PlainDecimal number = read_plain_decimal(begin, end);
  if (number.stop == nullptr) {
    const auto [stop, error] = std::from_chars(begin, end, number.value);
    if (error != std::errc() || !std::isfinite(number.value)) return false;
    number.stop = stop;
    number.point = decimal_mark_ == 0 && std::find(begin, stop, '.') != stop;
  }
  if (number.stop != end && *number.stop != layout_.delimiter) return false;
  if (number.point) decimal_mark_ = '.';
  value = number.value;
  at = static_cast<std::size_t>(number.stop - line.data());
  return true;
}

bool CsvReader::refuse_number(NumberFault fault, std::string_view line, std::string_view field,
                              std::size_t column) {
  if (field_count(line, layout_.delimiter) != places_.size()) return refuse_ragged(line);
  return refuse(words_for(fault, field), is_unknown(fault) ? layout_.unknown_remedy : "", column);
}

bool CsvReader::refuse_ragged(std::string_view line) {
  constexpr std::size_t kFirstRows = 5;  // lines before the table may have been read as rows
  const std::size_t fields = field_count(line, layout_.delimiter);
  std::string remedy =
      fmt::format("the detected delimiter is {}",
                  layout_.delimiter == '\t' ? std::string("a tab") : fmt::format("'{}'", layout_.delimiter));
  if (rows_ < kFirstRows) remedy += "; --skip N ignores N lines before the table";
  return refuse(fmt::format("has {} field{} instead of {}", fields, fields == 1 ? "" : "s", places_.size()),
                std::move(remedy));
}

bool CsvReader::refuse_blank() {
  line_ = blank_line_;
  return refuse("is blank, but rows follow", "rows must not be missing: import the parts separately");
}

bool CsvReader::refuse(std::string what, std::string remedy, std::optional<std::size_t> column) {
  std::string where = fmt::format("{}: line {}", file_, line_);
  if (column) where += ", " + column_in_words(layout_.columns, *column);
  error_ = schema::Error{ErrorKind::malformed, std::move(what), std::move(where), std::move(remedy)};
  return false;
}

// Not std::vector, which would first set to zero what is then overwritten.
void CsvReader::make_room(std::size_t numbers) {
  if (store_.room - store_.count >= numbers) return;
  const std::size_t room = std::max(2 * store_.room, store_.count + numbers);
  auto larger = std::make_unique_for_overwrite<double[]>(room);
  std::copy_n(store_.numbers.get(), store_.count, larger.get());
  store_.numbers = std::move(larger);
  store_.room = room;
}

void CsvReader::note_row() {
  const bool follows =
      !landmarks_.empty() && landmarks_.back().line + (rows_ - landmarks_.back().row) == line_;
  if (!follows) landmarks_.push_back({rows_, line_});
  blank_line_ = 0;
  ++rows_;
  store_.count += kept_;
}

}  // namespace tacto::capture
