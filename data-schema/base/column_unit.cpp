// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/column_unit.hpp"

#include <algorithm>
#include <cctype>

namespace tacto::schema {
namespace {

struct Spelling {
  std::string_view written, symbol;
};

constexpr Spelling kSpellings[] = {
    {"sec", "s"},         {"secs", "s"},       {"seconds", "s"},    {"Seconds", "s"},
    {"Sekunden", "s"},    {"msec", "ms"},      {"Volt", "V"},       {"Volts", "V"},
    {"volts", "V"},       {"Newton", "N"},     {"Newtons", "N"},    {"newtons", "N"},
    {"Meter", "m"},       {"Meters", "m"},     {"meters", "m"},     {"m/s2", "m/s^2"},
    {"m/s/s", "m/s^2"},   {"m/s**2", "m/s^2"}, {"mm/s2", "mm/s^2"}, {"mm/s/s", "mm/s^2"},
    {"mm/sec", "mm/s"},   {"m/sec", "m/s"},    {"micron", "um"},    {"microns", "um"},
    {"\u212B", "\u00C5"},  // the sign of the angstrom: another character that looks the same
};

// Whether a pair of matching brackets encloses the whole text.
bool is_bracketed(std::string_view text) {
  if (text.size() < 2) return false;
  const char first = text.front(), last = text.back();
  return (first == '(' && last == ')') || (first == '[' && last == ']') || (first == '<' && last == '>');
}

std::string_view without_brackets(std::string_view text) {
  text = without_blanks(text);
  return is_bracketed(text) ? without_blanks(text.substr(1, text.size() - 2)) : text;
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

// "x" and "mm" of "x_mm", "speed" and "cm/s" of "speed_cm_per_s" or "speed_cm_s": the longest unit; empty if
// the name does not end in a unit.
NameWithUnit split_at_underline(std::string_view name) {
  for (auto at = name.find('_', 1); at < name.size(); at = name.find('_', at + 1)) {
    std::string end(name.substr(at + 1));
    if (const auto unit = unit_with_ending(name.substr(at)); unit)
      return {std::string(name.substr(0, at)), std::string(unit->symbol)};
    if (const auto per = end.find("_per_"); per != std::string::npos) end.replace(per, 5, "/");
    const bool letters = std::ranges::all_of(end, [](unsigned char c) { return std::isdigit(c) == 0; });
    if (std::string ratio = end; letters && std::ranges::count(ratio, '_') == 1) {
      std::ranges::replace(ratio, '_', '/');
      if (is_known_unit(ratio)) return {std::string(name.substr(0, at)), ratio};
    }
    if (letters && is_known_unit(end)) return {std::string(name.substr(0, at)), end};
  }
  return {std::string(name), ""};
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

NameWithUnit split_unit(std::string_view name) {
  name = without_blanks(name);
  const auto bracket = bracket_in(name);
  if (bracket != std::string_view::npos && bracket > 0)
    return {std::string(without_blanks(name.substr(0, bracket))),
            std::string(without_brackets(name.substr(bracket)))};
  for (auto slash = name.find('/'); slash != std::string_view::npos; slash = name.find('/', slash + 1))
    if (slash > 0 && is_known_unit(name.substr(slash + 1)))
      return {std::string(without_blanks(name.substr(0, slash))),
              std::string(without_blanks(name.substr(slash + 1)))};
  return split_at_underline(name);
}

std::optional<Unit> known_unit(std::string_view text, Dimension target) {
  const std::string_view symbol = symbol_of(text);
  if (symbol.empty()) return std::nullopt;
  if (symbol == "\u00C5") return Unit{symbol, Dimension::length, 1e-10};  // heights of stylus instruments
  if (const auto worth = parse_quantity("1 " + std::string(symbol), target))
    return Unit{symbol, target, *worth};
  const auto unit = parse_unit(symbol);
  return unit ? std::optional(*unit) : std::nullopt;
}

bool is_known_unit(std::string_view text) {
  return known_unit(text, Dimension::length).has_value();
}

bool may_be_unit(std::string_view text) {
  text = without_blanks(text);
  return text.empty() || text == "-" || text == "--" || is_bracketed(text) || is_known_unit(text);
}

}  // namespace tacto::schema
