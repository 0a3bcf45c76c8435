// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/channel_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "capture/table/csv_number.hpp"
#include "capture/table/source.hpp"
#include "data-schema/base/column_unit.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

// The column of the text, and the text after it.
struct Cut {
  std::size_t column = 0;
  std::string_view rest;
};

bool may_follow_column(std::string_view rest) {
  return rest.empty() || rest[0] == '*' || rest[0] == '+' || rest[0] == '-';
}

std::vector<std::string> names_without_units(const std::vector<std::string>& names) {
  std::vector<std::string> all;
  for (const std::string& name : names) all.push_back(schema::split_unit(name).name);
  return all;
}

// A name in a header may contain any character, so the longest name at the beginning of the text is used.
std::optional<Cut> cut_by_name(std::string_view text, const std::vector<std::string>& columns) {
  std::optional<Cut> best;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& name = columns[i];
    if (name.empty() || !text.starts_with(name)) continue;
    const std::string_view rest = trimmed(text.substr(name.size()));
    if (may_follow_column(rest) && (!best || name.size() > columns[best->column].size())) best = Cut{i, rest};
  }
  return best;
}

std::optional<Cut> cut_by_number(std::string_view text, std::size_t columns) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view rest = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  if (error != std::errc() || number < 1 || number > columns || !may_follow_column(rest)) return std::nullopt;
  return Cut{number - 1, rest};
}

Result<Cut> cut_column(std::string_view text, const std::vector<std::string>& columns) {
  text = trimmed(text);
  for (const auto& names : {columns, names_without_units(columns)}) {
    const auto named = cut_by_name(text, names);
    if (named && std::ranges::count(names, names[named->column]) > 1)
      return fail(ErrorKind::usage, fmt::format("several columns have the name '{}'", names[named->column]),
                  {}, "choose one by its number: " + columns_in_words(columns));
    if (named) return *named;
  }
  if (const auto numbered = cut_by_number(text, columns.size())) return *numbered;
  return fail(ErrorKind::usage,
              fmt::format("there is no column '{}'", trimmed(text.substr(0, text.find('*')))), {},
              "the columns are: " + columns_in_words(columns));
}

std::optional<double> take_number(std::string_view& text) {
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text = trimmed(digits.substr(static_cast<std::size_t>(end - digits.data())));
  return value;
}

// "*0.5+3um" without the column: first the numbers, then the text after them as the unit of both.
struct Calibration {
  double scale = 1;
  double offset = 0;
  std::string_view unit;
};

std::optional<Calibration> read_calibration(std::string_view rest) {
  Calibration calibration;
  if (rest.starts_with('*')) {
    rest = trimmed(rest.substr(1));
    // "*mm" is "*1mm".
    const bool bare_unit = !rest.empty() && std::isalpha(static_cast<unsigned char>(rest[0])) != 0;
    const auto scale = bare_unit ? std::optional(1.0) : take_number(rest);
    if (!scale) return std::nullopt;
    calibration.scale = *scale;
  }
  if (rest.starts_with('+') || rest.starts_with('-')) {
    const auto offset = take_number(rest);
    if (!offset) return std::nullopt;
    calibration.offset = *offset;
  }
  calibration.unit = rest;
  return calibration;
}

std::string fitting(Dimension dimension) {
  return "possible units: " + schema::units_of(dimension);
}

Result<double> worth_of_columns_unit(const std::string& column_unit, Dimension dimension) {
  const std::string example = ", as in '*1" + std::string(schema::si_symbol(dimension)) + "'";
  if (column_unit.empty()) return fail(ErrorKind::usage, "has no unit", {}, fitting(dimension) + example);
  const auto known = schema::known_unit(column_unit, dimension);
  if (known && known->dimension == dimension) return known->si;
  return fail(ErrorKind::usage,
              fmt::format("has no unit, and that of the column, '{}', {}", column_unit,
                          known ? "is of another quantity" : "is not known"),
              {}, fitting(dimension) + example);
}

Result<double> si_worth(std::string_view unit, Dimension dimension, const std::string& column_unit) {
  if (unit.empty() && dimension == Dimension::none) return 1.0;
  if (unit.empty()) return worth_of_columns_unit(column_unit, dimension);
  if (const auto worth = schema::parse_quantity("1 " + std::string(unit), dimension)) return *worth;
  const bool of_another = schema::parse_unit(unit).has_value();
  return fail(ErrorKind::usage,
              fmt::format("'{}' is {}", unit, of_another ? "a unit of another quantity" : "not a known unit"),
              {}, fitting(dimension));
}

// The error of a part, reported with the whole text of the option.
tl::unexpected<schema::Error> in_option(const schema::Error& error, std::string_view text) {
  schema::Error whole = error;
  whole.where = fmt::format("'{}'", text);
  return tl::unexpected(whole);
}

Result<ScaledColumn> scaled(std::string_view text, Dimension dimension, const ColumnNames& columns) {
  const auto cut = cut_column(text, columns.names);
  TACTO_TRY(cut);
  const auto calibration = read_calibration(cut->rest);
  if (!calibration)
    return fail(ErrorKind::usage, fmt::format("'{}' is not a scale with an offset", cut->rest), {},
                fmt::format("write COLUMN*SCALE+OFFSET and a unit of {}", schema::units_of(dimension)));
  const auto si = si_worth(calibration->unit, dimension, columns.units[cut->column]);
  TACTO_TRY(si);
  if (calibration->scale == 0) return fail(ErrorKind::usage, "has a scale of 0, which removes the column");
  ScaledColumn column{cut->column, calibration->scale * *si, calibration->offset * *si};
  const std::string& own = columns.units[cut->column];
  const auto known = own.empty() ? std::nullopt : schema::known_unit(own, dimension);
  const bool same = known && (known->si == *si || std::abs(std::abs(column.scale) / known->si - 1) < 1e-9);
  if (known && known->dimension == dimension && !same) column.other_unit = own;
  return column;
}

Result<ChannelSpec> channel_without_column(std::string_view name) {
  const auto colon = name.rfind(':');
  const std::string quantity(colon == std::string_view::npos ? name : name.substr(colon + 1));
  const auto known = schema::quantity_named(quantity);
  TACTO_TRY(known);
  const std::string label(name.substr(0, colon));
  if (label.empty()) return fail(ErrorKind::usage, "has an empty label before ':'");
  return ChannelSpec{label, quantity, known->dimension, {}};
}

}  // namespace

Result<ScaledColumn> parse_scaled_column(std::string_view text, Dimension dimension,
                                         const ColumnNames& columns) {
  auto column = scaled(text, dimension, columns);
  return column ? column : in_option(column.error(), text);
}

Result<ChannelSpec> parse_channel(std::string_view text, const ColumnNames& columns) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos)
    return in_option({ErrorKind::usage, "has no column", {}, "write QUANTITY=COLUMN*SCALE and a unit"}, text);
  auto spec = channel_without_column(trimmed(text.substr(0, equals)));
  if (!spec) return in_option(spec.error(), text);
  const auto column = scaled(text.substr(equals + 1), spec->dimension, columns);
  if (!column) return in_option(column.error(), text);
  spec->source = *column;
  return spec;
}

Result<std::vector<ChannelSpec>> parse_channels(const std::vector<std::string>& texts,
                                                const ColumnNames& columns) {
  std::vector<ChannelSpec> specs;
  for (const std::string& text : texts) {
    auto spec = parse_channel(text, columns);
    TACTO_TRY(spec);
    if (std::ranges::find(specs, spec->name, &ChannelSpec::name) != specs.end())
      return in_option({ErrorKind::usage,
                        fmt::format("there are two channels '{}'", spec->name),
                        {},
                        fmt::format("give one of them a label: LABEL:{}=COLUMN...", spec->quantity)},
                       text);
    specs.push_back(std::move(*spec));
  }
  return specs;
}

}  // namespace tacto::capture
