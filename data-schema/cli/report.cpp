// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "data-schema/cli/harmless.hpp"
#include "data-schema/quantity.hpp"

namespace tacto::cli {

using schema::Dimension;

namespace {

struct Suffix {
  std::string_view text;
  std::optional<Dimension> dimension;  // none: the unit is printed as it is
  std::string_view unit;
};

// Longest first, so that "_n_per_m" is not taken for "_per_m".
constexpr Suffix kSuffixes[] = {
    {"_n_per_sqrt_hz", std::nullopt, "N/sqrt(Hz)"},
    {"_n_s_per_m", std::nullopt, "N s/m"},
    {"_v_per_n", std::nullopt, "V/N"},
    {"_v_per_s", std::nullopt, "V/s"},
    {"_n_per_m", std::nullopt, "N/m"},
    {"_n_per_v", std::nullopt, "N/V"},
    {"_m_per_n", Dimension::compliance, ""},
    {"_m_per_v", std::nullopt, "m/V"},
    {"_per_m", Dimension::spatial_frequency, ""},
    {"_percent", std::nullopt, "%"},
    {"_mb_per_s", std::nullopt, "MB/s"},
    {"_ppm", std::nullopt, "ppm"},
    {"_mps2", Dimension::acceleration, ""},
    {"_mps", Dimension::speed, ""},
    {"_ohm", std::nullopt, "ohm"},
    {"_hz", Dimension::frequency, ""},
    {"_kg", std::nullopt, "kg"},
    {"_db", std::nullopt, "dB"},
    {"_s", Dimension::time, ""},
    {"_m", Dimension::length, ""},
    {"_n", Dimension::force, ""},
    {"_v", Dimension::voltage, ""},
    {"_f", std::nullopt, "F"},
};

const Suffix* suffix_of(std::string_view key) {
  const auto found = std::ranges::find_if(kSuffixes, [&](const Suffix& s) { return key.ends_with(s.text); });
  return found == std::end(kSuffixes) ? nullptr : found;
}

std::string label_of(std::string_view key) {
  if (const Suffix* suffix = suffix_of(key)) key.remove_suffix(suffix->text.size());
  std::string label(key);
  std::ranges::replace(label, '_', ' ');
  return label;
}

std::string number_for_people(std::string_view key, double value) {
  const Suffix* suffix = suffix_of(key);
  if (!std::isfinite(value)) return "unknown";
  if (suffix == nullptr) return fmt::format("{:.4g}", value);
  if (suffix->dimension) return schema::for_people(value, *suffix->dimension);
  return fmt::format("{:.4g} {}", value, suffix->unit);
}

// Columns by display width: UTF-8 continuation bytes take no room.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}

}  // namespace

struct ReportPrinter {
  static std::string cell(const std::string& key, const Report::Value& value) {
    if (const auto* number = std::get_if<double>(&value)) return number_for_people(key, *number);
    if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "yes" : "no";
    if (const auto* text = std::get_if<std::string>(&value)) return harmless(*text);
    if (const auto* lines = std::get_if<std::vector<std::string>>(&value))
      return harmless(fmt::format("{}", fmt::join(*lines, "; ")));
    return "";
  }

  static std::vector<std::string> header(const std::vector<Report>& rows) {
    std::vector<std::string> keys;
    for (const Report& row : rows)
      for (const auto& [key, value] : row.entries_)
        if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    return keys;
  }

  static std::string find_cell(const Report& row, const std::string& key) {
    for (const auto& [name, value] : row.entries_)
      if (name == key) return cell(key, value);
    return "";
  }

  static std::string table(const std::vector<Report>& rows) {
    const auto keys = header(rows);
    std::vector<std::vector<std::string>> lines(rows.size() + 1);
    for (const auto& key : keys) lines[0].push_back(label_of(key));
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (const auto& key : keys) lines[r + 1].push_back(find_cell(rows[r], key));
    return aligned(lines);
  }

  // Rows too wide for a line, or with tables of their own, stand one under the other.
  static std::string list(const std::vector<Report>& rows) {
    constexpr std::size_t kWidestTable = 20;
    const auto nested = [](const auto& entry) {
      return std::holds_alternative<std::vector<Report>>(entry.second);
    };
    const auto has_table = [&](const Report& row) { return std::ranges::any_of(row.entries_, nested); };
    if (rows.empty()) return "  none\n";
    if (header(rows).size() <= kWidestTable && std::ranges::none_of(rows, has_table)) return table(rows);
    std::string text;
    for (const Report& row : rows) text += "\n" + row.for_people();
    return text;
  }

  static std::string aligned(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> widths(lines[0].size(), 0);
    for (const auto& line : lines)
      for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], width_of(line[c]));
    std::string text;
    for (const auto& line : lines) {
      std::string row = " ";
      for (std::size_t c = 0; c < line.size(); ++c) row += " " + padded(line[c], widths[c]) + " ";
      text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
  }

  static nlohmann::ordered_json json(const Report& report) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const auto& [key, value] : report.entries_)
      std::visit([&, k = &key](const auto& v) { object[*k] = json_value(v); }, value);
    return object;
  }

  static nlohmann::ordered_json json_value(const std::vector<Report>& rows) {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const Report& row : rows) array.push_back(json(row));
    return array;
  }
  static nlohmann::ordered_json json_value(const auto& plain) { return plain; }
};

Report& Report::put(std::string key, Value value) {
  entries_.emplace_back(std::move(key), std::move(value));
  return *this;
}
Report& Report::add(std::string key, double value_si) {
  return put(std::move(key), value_si);
}
Report& Report::add(std::string key, std::string text) {
  return put(std::move(key), std::move(text));
}
Report& Report::add(std::string key, bool value) {
  return put(std::move(key), value);
}
Report& Report::add(std::string key, std::vector<Report> rows) {
  return put(std::move(key), std::move(rows));
}
Report& Report::add(std::string key, std::vector<std::string> lines) {
  return put(std::move(key), std::move(lines));
}

Report& Report::ends_with(schema::Fault fault) {
  exit_code_ = schema::exit_code(fault);
  return *this;
}

std::string Report::for_people() const {
  std::size_t width = 0;
  for (const auto& [key, value] : entries_) width = std::max(width, width_of(label_of(key)));
  std::string text;
  for (const auto& [key, value] : entries_) {
    if (const auto* rows = std::get_if<std::vector<Report>>(&value)) {
      text += label_of(key) + "\n" + ReportPrinter::list(*rows);
      continue;
    }
    text += padded(label_of(key), width + 2) + ReportPrinter::cell(key, value) + "\n";
  }
  return text;
}

std::string Report::json() const {
  using Dump = nlohmann::ordered_json;
  return ReportPrinter::json(*this).dump(2, ' ', false, Dump::error_handler_t::replace) + "\n";
}

}  // namespace tacto::cli
