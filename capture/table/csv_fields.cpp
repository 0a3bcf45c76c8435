// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/csv_fields.hpp"

#include <algorithm>

#include "capture/table/csv_number.hpp"

namespace tacto::capture {
namespace {

bool is_quoted(std::string_view field) {
  return field.size() >= 2 && field.front() == '"' && field.back() == '"';
}

// Only a quote at the beginning of a field protects delimiters; a quote inside it (3.5" disk) is an ordinary
// character.
bool opens_with_quote(std::string_view line, std::size_t begin) {
  const std::size_t first = line.find_first_not_of(' ', begin);
  return first != std::string_view::npos && line[first] == '"';
}

}  // namespace

std::size_t field_end(std::string_view line, std::size_t begin, char delimiter) {
  if (!opens_with_quote(line, begin)) return std::min(line.find(delimiter, begin), line.size());
  bool inside = false;
  for (std::size_t i = begin; i < line.size(); ++i) {
    if (line[i] == '"') inside = !inside;
    if (line[i] == delimiter && !inside) return i;
  }
  return line.size();
}

std::size_t field_count(std::string_view line, char delimiter) {
  std::size_t count = 1;
  for (std::size_t end = field_end(line, 0, delimiter); end < line.size(); ++count)
    end = field_end(line, end + 1, delimiter);
  return count;
}

std::string unquoted(std::string_view field) {
  field = trimmed(field);
  if (!is_quoted(field)) return std::string(field);
  std::string text(trimmed(field.substr(1, field.size() - 2)));
  for (auto at = text.find("\"\""); at != std::string::npos; at = text.find("\"\"", at + 1))
    text.erase(at, 1);
  return text;
}

std::vector<std::string> fields_of(std::string_view line, char delimiter) {
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = field_end(line, begin, delimiter);
    fields.push_back(unquoted(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

std::string_view without_returns(std::string_view line) {
  while (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool is_blank_line(std::string_view line) {
  return line.find_first_not_of(" \r") == std::string_view::npos;
}

bool is_comment_line(std::string_view line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first != std::string_view::npos && line[first] == '#';
}

}  // namespace tacto::capture
