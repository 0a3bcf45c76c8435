// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace tacto::schema {
namespace {

// In each dimension from small to large: for_people picks the largest unit that leaves the value at 1 or
// above. Some are only read: "cm" would surprise where "12 mm" is expected.
constexpr Unit kUnits[] = {
    {"nm", Dimension::length, 1e-9},
    {"um", Dimension::length, 1e-6},
    {"mm", Dimension::length, 1e-3},
    {"cm", Dimension::length, 1e-2, "", true},
    {"m", Dimension::length, 1},
    {"ns", Dimension::time, 1e-9},
    {"us", Dimension::time, 1e-6},
    {"ms", Dimension::time, 1e-3},
    {"s", Dimension::time, 1},
    {"min", Dimension::time, 60, "", true},
    {"h", Dimension::time, 3600, "", true},
    {"days", Dimension::time, 86400, "", true},
    {"mHz", Dimension::frequency, 1e-3},
    {"Hz", Dimension::frequency, 1, "_hz"},
    {"kHz", Dimension::frequency, 1e3, "_khz"},
    {"MHz", Dimension::frequency, 1e6},
    {"/m", Dimension::spatial_frequency, 1, "_per_m", true},
    {"/cm", Dimension::spatial_frequency, 1e2, "", true},
    {"/mm", Dimension::spatial_frequency, 1e3},
    {"/um", Dimension::spatial_frequency, 1e6, "", true},
    {"um/s", Dimension::speed, 1e-6},
    {"mm/s", Dimension::speed, 1e-3},
    {"cm/s", Dimension::speed, 1e-2, "", true},
    {"m/s", Dimension::speed, 1, "_mps"},
    {"mm/s^2", Dimension::acceleration, 1e-3},
    {"m/s^2", Dimension::acceleration, 1, "_mps2"},
    {"mg", Dimension::acceleration, 1e-3 * kStandardGravity_mps2, "", true},
    {"g", Dimension::acceleration, kStandardGravity_mps2, "", true},
    {"uN", Dimension::force, 1e-6},
    {"mN", Dimension::force, 1e-3, "_mn"},
    {"N", Dimension::force, 1, "_n"},
    {"kN", Dimension::force, 1e3},
    {"uV", Dimension::voltage, 1e-6},
    {"mV", Dimension::voltage, 1e-3, "_mv"},
    {"V", Dimension::voltage, 1, "_v"},
    {"kV", Dimension::voltage, 1e3},
    {"nm/N", Dimension::compliance, 1e-9},
    {"um/N", Dimension::compliance, 1e-6},
    {"mm/N", Dimension::compliance, 1e-3},
    {"m/N", Dimension::compliance, 1, "_m_per_n"},
    {"1", Dimension::none, 1},
    {"dB", Dimension::level, 1},
    {"mg", Dimension::mass, 1e-6},
    {"g", Dimension::mass, 1e-3},
    {"kg", Dimension::mass, 1},
    {"ppm", Dimension::share, 1e-6},
    {"%", Dimension::share, 1e-2},
};

std::string_view trimmed_symbol(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// Both Unicode micro signs (U+00B5 and U+03BC) become "u", a raised 2 "^2"; "1/mm" and "mm^-1" become "/mm".
std::string canonical(std::string_view symbol) {
  std::string text(trimmed_symbol(symbol));
  for (std::string_view micro : {"\xC2\xB5", "\xCE\xBC"})
    for (auto at = text.find(micro); at != std::string::npos; at = text.find(micro)) text.replace(at, 2, "u");
  constexpr std::string_view kSquared = "\xC2\xB2";
  if (text.ends_with(kSquared)) text.replace(text.size() - kSquared.size(), kSquared.size(), "^2");
  if (text.size() > 2 && text.starts_with("1/")) text.erase(0, 1);
  if (text.ends_with("^-1")) text = "/" + text.substr(0, text.size() - 3);
  return text;
}

// "g" is a mass and an acceleration: the requested dimension decides, else the first that has it.
std::optional<Unit> unit_named(std::string_view symbol, Dimension target = Dimension::mass) {
  std::optional<Unit> any;
  for (const Unit& unit : kUnits) {
    if (unit.symbol != symbol) continue;
    if (unit.dimension == target) return unit;
    if (!any) any = unit;
  }
  return any;
}

std::string ending_of(const Unit& unit) {
  return unit.ending.empty() ? "_" + std::string(unit.symbol) : std::string(unit.ending);
}

struct NumberAndUnit {
  double number = 0;
  std::string unit;
};

std::optional<NumberAndUnit> split(std::string_view text) {
  NumberAndUnit parts;
  text = trimmed_symbol(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), parts.number);
  if (fault != std::errc() || !std::isfinite(parts.number)) return std::nullopt;
  parts.unit = canonical(text.substr(static_cast<std::size_t>(end - text.data())));
  return parts;
}

tl::unexpected<Error> wrong(std::string_view text, std::string_view why, Dimension dimension) {
  return fail(ErrorKind::usage, fmt::format("'{}' {}", text, why), {},
              dimension == Dimension::none
                  ? "give a number without a unit"
                  : fmt::format("give a number with one of: {}", units_of(dimension)));
}

}  // namespace

std::string units_of(Dimension dimension) {
  std::string list;
  for (const Unit& unit : kUnits) {
    if (unit.dimension != dimension) continue;
    list += (list.empty() ? "" : ", ") + std::string(unit.symbol);
  }
  return list;
}

Result<double> parse_quantity(std::string_view text, Dimension dimension) {
  const auto parts = split(text);
  if (!parts) return wrong(text, "is not a finite number with a unit", dimension);
  if (parts->unit.empty()) {
    if (dimension == Dimension::none) return parts->number;
    return wrong(text, "has no unit", dimension);
  }
  const auto unit = unit_named(parts->unit, dimension);
  if (!unit) return wrong(text, fmt::format("has the unknown unit '{}'", parts->unit), dimension);
  if (unit->dimension != dimension) return wrong(text, "has a unit of another quantity", dimension);
  return parts->number * unit->si;
}

Result<Unit> parse_unit(std::string_view symbol) {
  if (const auto unit = unit_named(canonical(symbol))) return *unit;
  std::string known;
  for (const Unit& unit : kUnits)
    if (unit_named(unit.symbol)->dimension == unit.dimension)  // once each
      known += (known.empty() ? "" : ", ") + std::string(unit.symbol);
  return fail(ErrorKind::usage, fmt::format("'{}' is not a known unit", symbol), {},
              "the units are: " + known);
}

std::optional<Unit> unit_with_ending(std::string_view ending) {
  const auto has_it = [&](const Unit& unit) {
    return unit.dimension != Dimension::none && ending_of(unit) == ending;
  };
  const auto found = std::ranges::find_if(kUnits, has_it);
  return found == std::end(kUnits) ? std::nullopt : std::optional(*found);
}

std::string key_in(std::string_view key, std::string_view symbol) {
  const auto unit = unit_named(symbol);
  const bool named = unit && unit->si == 1 && unit->dimension != Dimension::none;
  return std::string(key) + (named ? ending_of(*unit) : "");
}

std::string_view si_symbol(Dimension dimension) {
  constexpr std::array<std::string_view, 13> kSymbols = {"m", "s",   "Hz", "1/m", "m/s", "m/s^2", "N",
                                                         "V", "m/N", "1",  "dB",  "kg",  "1"};
  return kSymbols[static_cast<std::size_t>(dimension)];
}

std::string for_people(double value_si, Dimension dimension) {
  constexpr double kHalfDigit = 5e-5;  // four digits are printed
  const Unit* best = nullptr;
  for (const Unit& unit : kUnits) {
    if (unit.dimension != dimension || unit.only_read) continue;
    // 1e-6 m may be slightly less: it is 1 um, not 1000 nm.
    if (best == nullptr || std::abs(value_si) >= (1 - kHalfDigit) * unit.si ||
        (value_si == 0 && unit.si <= 1))
      best = &unit;
  }
  if (best->dimension == Dimension::none) return fmt::format("{:.4g}", value_si);
  const bool inverse = best->symbol.starts_with('/');
  return fmt::format("{:.4g}{}{}", value_si / best->si, inverse ? "" : " ", best->symbol);
}

}  // namespace tacto::schema
