// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/report/value_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "data-schema/base/quantity.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::cli {

using schema::Dimension;

namespace {

struct Suffix {
  std::string_view text;
  std::string_view unit;                    // printed as it is
  std::optional<Dimension> dimension = {};  // the value is printed in a unit that fits it
};

// Units without a prefix of their own for small and large values. Longest first, so that "_n_per_m" is not
// read as "_per_m".
constexpr Suffix kSuffixes[] = {
    {"_n_per_sqrt_hz", "N/sqrt(Hz)"},
    {"_n_s_per_m", "N s/m"},
    {"_v_per_n", "V/N"},
    {"_v_per_s", "V/s"},
    {"_n_per_s", "N/s"},
    {"_n_per_m", "N/m"},
    {"_n_per_v", "N/V"},
    {"_m_per_v", "m/V"},
    {"_mb_per_s", "MB/s"},
    {"_percent", "%"},
    {"_m3", "m^3"},
    {"_per_s", "1/s"},
    {"_ppm", "ppm"},
    {"_ohm", "ohm"},
    {"_kg", "kg"},
    {"_deg", "degrees"},
    {"_db", "dB"},
    {"_f", "F"},
    {"_j", "J"},
    {"_c", "C"},
};

std::optional<Suffix> suffix_of(std::string_view key) {
  const auto found = std::ranges::find_if(kSuffixes, [&](const Suffix& s) { return key.ends_with(s.text); });
  if (found != std::end(kSuffixes)) return *found;
  for (auto at = key.find('_'); at != std::string_view::npos; at = key.find('_', at + 1))
    if (const auto unit = schema::unit_with_ending(key.substr(at)); unit && unit->si == 1)
      return Suffix{key.substr(at), unit->symbol, unit->dimension};
  return std::nullopt;
}

std::string number_for_people(std::string_view key, double value) {
  const auto suffix = suffix_of(key);
  if (!std::isfinite(value)) return "unknown";
  if (value == 0) value = 0;  // not -0
  if (!suffix) return fmt::format("{:.4g}", value);
  if (suffix->dimension) return schema::for_people(value, *suffix->dimension);
  const bool whole = std::abs(value) >= 1e4 && std::abs(value) < 1e6;  // 11000, not 1.1e+04
  return whole ? fmt::format("{:.0f} {}", value, suffix->unit)
               : fmt::format("{:.4g} {}", value, suffix->unit);
}

std::string label_of(std::string_view key) {
  if (const auto suffix = suffix_of(key)) key.remove_suffix(suffix->text.size());
  std::string label(key);
  std::ranges::replace(label, '_', ' ');
  return label;
}

// What tells two labels apart. Not the SI unit: the value may be printed in another one (mm, ms).
std::string_view difference_of(const Suffix& suffix) {
  if (!suffix.dimension) return suffix.unit;
  switch (*suffix.dimension) {
    case Dimension::length:
      return "length";
    case Dimension::time:
      return "time";
    case Dimension::frequency:
      return "frequency";
    case Dimension::spatial_frequency:
      return "spatial frequency";
    case Dimension::speed:
      return "speed";
    case Dimension::acceleration:
      return "acceleration";
    case Dimension::force:
      return "force";
    case Dimension::voltage:
      return "voltage";
    case Dimension::compliance:
      return "displacement per force";
    default:
      return suffix.unit;
  }
}

}  // namespace

std::vector<std::string> labels_of(const std::vector<std::string>& keys) {
  std::vector<std::string> plain, labels;
  for (const std::string& key : keys) plain.push_back(label_of(key));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto suffix = suffix_of(keys[i]);
    const bool alone = !suffix || std::ranges::count(plain, plain[i]) == 1;
    labels.push_back(alone ? plain[i] : fmt::format("{} ({})", plain[i], difference_of(*suffix)));
  }
  return labels;
}

std::string label_with_unit(std::string_view key) {
  const auto suffix = suffix_of(key);
  return suffix ? fmt::format("{} ({})", label_of(key), suffix->unit) : label_of(key);
}

std::string cell_text(const std::string& key, const ReportPrinter::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return number_for_people(key, *number);
  if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "yes" : "no";
  if (const auto* text = std::get_if<std::string>(&value)) return without_controls(*text);
  if (const auto* lines = std::get_if<std::vector<std::string>>(&value))
    return without_controls(fmt::format("{}", fmt::join(*lines, "; ")));
  return "";
}

// UTF-8's continuation bytes have no width.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}

}  // namespace tacto::cli
