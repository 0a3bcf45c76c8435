// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/column_unit.hpp"

#include "capture/table/csv_number.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;

struct Spelling {
  std::string_view written, symbol;
};

constexpr Spelling kSpellings[] = {
    {"sec", "s"},       {"secs", "s"},      {"seconds", "s"},    {"Seconds", "s"},    {"Sekunden", "s"},
    {"msec", "ms"},     {"Volt", "V"},      {"Volts", "V"},      {"volts", "V"},      {"Newton", "N"},
    {"Newtons", "N"},   {"newtons", "N"},   {"Meter", "m"},      {"Meters", "m"},     {"meters", "m"},
    {"m/s2", "m/s^2"},  {"m/s/s", "m/s^2"}, {"m/s**2", "m/s^2"}, {"mm/s2", "mm/s^2"}, {"mm/s/s", "mm/s^2"},
    {"mm/sec", "mm/s"}, {"m/sec", "m/s"},   {"micron", "um"},    {"microns", "um"},
};

// Whether a pair of matching brackets encloses the whole text.
bool is_bracketed(std::string_view text) {
  if (text.size() < 2) return false;
  const char first = text.front(), last = text.back();
  return (first == '(' && last == ')') || (first == '[' && last == ']') || (first == '<' && last == '>');
}

std::string_view without_brackets(std::string_view text) {
  text = trimmed(text);
  return is_bracketed(text) ? trimmed(text.substr(1, text.size() - 2)) : text;
}

std::string_view symbol_of(std::string_view text) {
  text = without_brackets(text);
  for (const Spelling& spelling : kSpellings)
    if (spelling.written == text) return spelling.symbol;
  return text;
}

// The start of the bracket at the end of a name; npos if there is none.
std::size_t bracket_in(std::string_view name) {
  if (name.ends_with(')')) return name.rfind('(');
  return name.ends_with(']') ? name.rfind('[') : std::string_view::npos;
}

}  // namespace

NameWithUnit split_unit(std::string_view name) {
  name = trimmed(name);
  const auto bracket = bracket_in(name);
  if (bracket != std::string_view::npos && bracket > 0)
    return {std::string(trimmed(name.substr(0, bracket))),
            std::string(without_brackets(name.substr(bracket)))};
  for (auto slash = name.find('/'); slash != std::string_view::npos; slash = name.find('/', slash + 1))
    if (slash > 0 && is_known_unit(name.substr(slash + 1)))
      return {std::string(trimmed(name.substr(0, slash))), std::string(trimmed(name.substr(slash + 1)))};
  return {std::string(name), ""};
}

std::optional<schema::Unit> known_unit(std::string_view text, Dimension target) {
  const std::string_view symbol = symbol_of(text);
  if (symbol.empty()) return std::nullopt;
  if (const auto worth = schema::parse_quantity("1 " + std::string(symbol), target))
    return schema::Unit{symbol, target, *worth};
  const auto unit = schema::parse_unit(symbol);
  return unit ? std::optional(*unit) : std::nullopt;
}

bool is_known_unit(std::string_view text) {
  return known_unit(text, Dimension::length).has_value();
}

bool may_be_unit(std::string_view text) {
  text = trimmed(text);
  return text.empty() || text == "-" || text == "--" || is_bracketed(text) || is_known_unit(text);
}

}  // namespace tacto::capture
