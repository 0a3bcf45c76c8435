// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/csv_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "capture/csv_fields.hpp"
#include "capture/csv_number.hpp"
#include "capture/text_encoding.hpp"

namespace tacto::capture {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kSampledLines = 20;

struct LayoutLine {
  std::string_view text;
  std::size_t number = 0;  // 1-based, of the file
  std::size_t next = 0;    // offset of the line after it
};

// The first lines with fields in them. A line that the head cuts off is none.
std::vector<LayoutLine> sample_lines(std::string_view head, bool whole, std::size_t begin, char line_end) {
  std::vector<LayoutLine> lines;
  for (std::size_t number = 1; begin < head.size() && lines.size() < kSampledLines; ++number) {
    const std::size_t end = head.find(line_end, begin);
    if (end == std::string_view::npos && !whole) break;
    const auto text = without_returns(head.substr(begin, end == std::string_view::npos ? end : end - begin));
    begin = end == std::string_view::npos ? head.size() : end + 1;
    if (!is_blank_line(text) && !is_comment_line(text)) lines.push_back({text, number, begin});
  }
  return lines;
}

// The largest number of lines that this delimiter cuts into equally many fields; 0 where it cuts none.
std::size_t agreeing_lines(const std::vector<LayoutLine>& lines, char delimiter) {
  std::map<std::size_t, std::size_t> lines_by_fields;
  for (const LayoutLine& line : lines) ++lines_by_fields[field_count(line.text, delimiter)];
  std::size_t most = 0;
  for (const auto& [fields, count] : lines_by_fields)
    if (fields > 1) most = std::max(most, count);
  return most;
}

// Where two agree alike, the rarer sign decides: in "0,5;1,5" the comma is decimal.
char find_delimiter(const std::vector<LayoutLine>& lines) {
  char best = ',';
  std::size_t most = 0;
  for (const char delimiter : {'\t', ';', ','}) {
    const std::size_t agreeing = agreeing_lines(lines, delimiter);
    if (agreeing > most) best = delimiter;
    most = std::max(most, agreeing);
  }
  return best;
}

bool is_name(const std::string& field) {
  char mark = 0;
  double value = 0;
  return read_number(field, mark, value) == NumberFault::text;
}

bool is_numeric(const std::string& field) {
  return !field.empty() && !is_name(field);
}

enum class FirstLine { header, data, mixed };

// Mixed lines are data where the next line has its text in the same columns (a column of dates, say).
FirstLine kind_of(const std::vector<std::string>& first, const std::vector<std::string>& next) {
  const auto names = std::ranges::count_if(first, is_name);
  const auto numbers = std::ranges::count_if(first, is_numeric);
  if (names == 0) return FirstLine::data;
  if (numbers == 0) return FirstLine::header;
  for (std::size_t i = 0; i < std::min(first.size(), next.size()); ++i)
    if (is_name(first[i]) && !is_name(next[i])) return names > numbers ? FirstLine::header : FirstLine::mixed;
  return FirstLine::data;
}

Result<void> check_text(std::string_view head, const std::string& file) {
  const bool utf16 = head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF");
  if (utf16) return fail(Fault::malformed, "is UTF-16 text", file, "save it as UTF-8");
  if (const auto zero = head.find('\0'); zero != std::string_view::npos)
    return fail(Fault::malformed, fmt::format("has a zero byte at {}: it is no text", zero), file);
  return {};
}

tl::unexpected<schema::Error> no_lines(std::string_view head, bool whole, const std::string& file) {
  if (head.empty()) return fail(Fault::malformed, "is empty", file);
  if (!whole)
    return fail(Fault::malformed, fmt::format("has no data in its first {} bytes", head.size()), file);
  return fail(Fault::malformed, "holds no data, only blank lines and comments", file);
}

tl::unexpected<schema::Error> mixed_first_line(const LayoutLine& line, const std::vector<std::string>& fields,
                                               const std::string& file) {
  const auto at = std::ranges::find_if(fields, is_name) - fields.begin();
  return fail(Fault::malformed,
              fmt::format("'{}' stands among numbers", fields[static_cast<std::size_t>(at)]),
              fmt::format("{}: line {}, column {}", file, line.number, at + 1),
              "name every column in the first line, or none");
}

void take_header(CsvLayout& layout, const LayoutLine& line, const std::vector<std::string>& fields) {
  layout.header = true;
  layout.columns = fields;
  layout.data_offset = line.next;
  layout.data_line = line.number + 1;
}

}  // namespace

Result<CsvLayout> find_csv_layout(std::string_view head, bool whole, const std::string& file) {
  if (const auto text = check_text(head, file); !text) return schema::forward_error(text);
  CsvLayout layout;
  layout.data_offset = head.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  const bool old_mac = head.find('\n') == std::string_view::npos && head.find('\r') != std::string_view::npos;
  layout.line_end = old_mac ? '\r' : '\n';
  const auto lines = sample_lines(head, whole, layout.data_offset, layout.line_end);
  if (lines.empty()) return no_lines(head.substr(layout.data_offset), whole, file);
  layout.delimiter = find_delimiter(lines);
  const auto first = fields_of(to_utf8(lines[0].text), layout.delimiter);
  const auto next =
      lines.size() > 1 ? fields_of(lines[1].text, layout.delimiter) : std::vector<std::string>{};
  layout.columns.resize(first.size());
  const FirstLine kind = kind_of(first, next);
  if (kind == FirstLine::mixed) return mixed_first_line(lines[0], first, file);
  if (kind == FirstLine::header) take_header(layout, lines[0], first);
  if (layout.header && lines.size() == 1 && whole)
    return fail(Fault::malformed, "has a header but no data",
                fmt::format("{}: line {}", file, lines[0].number));
  return layout;
}

}  // namespace tacto::capture
