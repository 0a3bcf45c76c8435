// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/csv_number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace tacto::capture {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return result;
}

// Text that stands for a number that is not finite: "nan", "-Inf", "1.#QNAN" (older Windows). "#NUM!" remains
// text.
NumberFault fault_of_words(std::string_view field) {
  std::string word = lower(field);
  if (word.starts_with('-') || word.starts_with('+')) word.erase(0, 1);
  if (word.starts_with("1.#")) word.erase(0, 3);
  if (word.starts_with("nan") || word.starts_with("qnan") || word.starts_with("snan") || word == "ind")
    return NumberFault::nan;
  if (word == "inf" || word == "infinity") return NumberFault::infinite;
  return NumberFault::text;
}

// from_chars supports only the decimal point, so a field with one decimal comma and no point is copied and
// the comma replaced.
NumberFault read_with_comma(std::string_view field, double& value) {
  std::array<char, 64> copy{};
  if (field.size() > copy.size() || field.find('.') != std::string_view::npos) return NumberFault::text;
  std::ranges::replace_copy(field, copy.begin(), ',', '.');
  const char* const end = copy.data() + field.size();
  const auto [stop, error] = std::from_chars(copy.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return NumberFault::text;
  return error == std::errc() ? NumberFault::none : NumberFault::too_large;
}

NumberFault read_with_point(std::string_view field, double& value) {
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return fault_of_words(field);
  if (error != std::errc()) return NumberFault::too_large;
  return std::isfinite(value) ? NumberFault::none : fault_of_words(field);
}

NumberFault check_mark(char shown, char& mark) {
  if (mark == 0) mark = shown;
  return mark == shown ? NumberFault::none : NumberFault::mixed_marks;
}

}  // namespace

std::string_view trimmed(std::string_view field) {
  while (!field.empty() && is_blank(field.front())) field.remove_prefix(1);
  while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
  return field;
}

bool is_name(std::string_view field) {
  char mark = 0;
  double value = 0;
  return read_number(field, mark, value) == NumberFault::text;
}

bool is_numeric(std::string_view field) {
  return !trimmed(field).empty() && !is_name(field);
}

NumberFault read_number(std::string_view field, char& mark, double& value) {
  field = trimmed(field);
  if (field.empty()) return NumberFault::missing;
  if (field.size() > 1 && field[0] == '+' && (is_digit(field[1]) || field[1] == '.' || field[1] == ','))
    field.remove_prefix(1);
  const bool comma = field.find(',') != std::string_view::npos;
  const bool point = field.find('.') != std::string_view::npos;
  const NumberFault fault = comma ? read_with_comma(field, value) : read_with_point(field, value);
  if (fault != NumberFault::none || comma == point) return fault;
  return check_mark(comma ? ',' : '.', mark);
}

}  // namespace tacto::capture
