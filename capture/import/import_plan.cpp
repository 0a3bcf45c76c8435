// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/import_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "data-schema/base/column_unit.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::capture {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

Result<void> check_output(const ImportRequest& request) {
  const std::string stem = schema::stem_of(request.name, "");
  std::error_code ignored;
  for (const std::string& path : {stem + ".wav", stem + ".json"}) {
    if (fs::equivalent(path, request.file, ignored))
      return fail(ErrorKind::usage, "is the imported file itself", path,
                  "choose another name for the recording");
    if (fs::exists(path, ignored) && !request.replace)
      return fail(ErrorKind::usage, "exists already", path,
                  "choose another name, or replace it with --force");
    schema::PendingFiles probe;
    TACTO_TRY(probe.add(path));
  }
  return {};
}

bool is_storable(double rate_hz) {
  constexpr double kLargest = std::numeric_limits<int>::max();  // the limit of a WAV header
  return std::round(rate_hz) >= 1 && rate_hz <= kLargest;
}

Result<void> check_rate(const std::optional<double>& rate_hz) {
  if (!rate_hz || is_storable(*rate_hz)) return {};
  return fail(ErrorKind::usage, fmt::format("a recording cannot have a rate of {:g} Hz", *rate_hz), "--rate",
              "give samples per second, for example --rate 10kHz");
}

// The name of a column if it is unique, otherwise its number: the text that the user can type after '='.
std::string typed(const Source& source, std::size_t column) {
  const std::string& name = source.columns[column];
  return name.empty() || std::ranges::count(source.columns, name) > 1 ? std::to_string(column + 1) : name;
}

std::string in_quotes(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// The option that takes the rate from the table's times, if a column has a unit of time; else an example of
// both.
std::string clock_example(const Source& source) {
  if (const auto column = time_column_of(source)) return "--time-column " + in_quotes(typed(source, *column));
  return "--rate, for example --rate 10kHz, or --time-column, for example --time-column " +
         in_quotes(typed(source, 0) + "*1s");
}

Result<void> check_clock(const ImportRequest& request, const Source& source) {
  if (request.rate_hz && !request.time_column.empty())
    return fail(ErrorKind::usage, "both --rate and --time-column were given", {}, "give only one of them");
  if (request.rate_hz || !request.time_column.empty() || source.rate_hz || source.xdf) return {};
  return fail(ErrorKind::usage, "the rate of the table is not known", source.file,
              "add " + clock_example(source));
}

// The first column; of a MATLAB file the first of the longest ones.
std::size_t example_column(const Source& source) {
  if (!source.mat) return 0;
  const auto longest = std::ranges::max_element(source.mat->columns, {}, &schema::MatColumn::rows);
  return static_cast<std::size_t>(longest - source.mat->columns.begin());
}

// The first column with such a unit.
std::optional<std::size_t> column_in(const Source& source, schema::Dimension dimension) {
  for (std::size_t i = 0; i < source.units.size(); ++i) {
    const auto unit = schema::known_unit(source.units[i], dimension);
    if (unit && unit->dimension == dimension) return i;
  }
  return std::nullopt;
}

// The columns with a unit of force and of length, which need no unit in the option; without a force an
// example.
std::string channels_example(const Source& source) {
  const auto force = column_in(source, schema::Dimension::force);
  const auto position = column_in(source, schema::Dimension::length);
  const std::string force_column =
      force ? typed(source, *force) : typed(source, example_column(source)) + "*1N";
  return "--channel " + in_quotes("tangential_force=" + force_column) +
         (position ? " --channel " + in_quotes("position=" + typed(source, *position)) : "");
}

tl::unexpected<schema::Error> no_channels(const Source& source) {
  if (source.columns.empty())
    return fail(ErrorKind::unsuitable, "has no array of real numbers", source.file,
                "see what it has with 'tactograph import FILE', without other options");
  return fail(
      ErrorKind::usage,
      "the channels of the columns are not known; the columns are: " + columns_in_words(source.columns),
      source.file, "give them, for example " + example_options(source));
}

// An option that names an array of a MATLAB file that has no columns: the reason. `text` begins with the
// name.
Result<void> check_refused(const Source& source, std::string_view text) {
  if (!source.mat) return {};
  for (const schema::MatArray& array : source.mat->arrays) {
    if (array.refusal.empty() || !text.starts_with(array.name)) continue;
    const std::string_view rest = text.substr(array.name.size());
    if (rest.empty() || std::string_view("*+-({").find(rest[0]) != std::string_view::npos)
      return fail(ErrorKind::unsuitable, array.refusal, fmt::format("{}: {}", source.file, array.name),
                  "import takes full arrays of real numbers: in MATLAB save such a one");
  }
  return {};
}

Result<void> check_refused(const ImportRequest& request, const Source& source) {
  for (const std::string& channel : request.channels)
    TACTO_TRY(check_refused(source, std::string_view(channel).substr(channel.find('=') + 1)));
  return check_refused(source, request.time_column);
}

// Integer codes are scaled as in an audio editor, to -1 to 1.
ChannelSpec whole_signal(const Source& source) {
  const double scale = source.code_bits > 0 ? std::ldexp(1.0, 1 - source.code_bits) : 1;
  return {"signal", "signal", schema::Dimension::none, {0, scale, 0}};
}

Result<std::vector<ChannelSpec>> choose_channels(const ImportRequest& request, const Source& source) {
  if (!request.channels.empty()) return parse_channels(request.channels, {source.columns, source.units});
  if (source.csv || source.mat || source.xdf || source.columns.size() != 1) return no_channels(source);
  return std::vector{whole_signal(source)};
}

bool has(const std::vector<ChannelSpec>& channels, std::string_view quantity) {
  return std::ranges::find(channels, quantity, &ChannelSpec::quantity) != channels.end();
}

Result<void> check_speed(const ImportRequest& request, const std::vector<ChannelSpec>& channels) {
  if (!request.speed_mps) return {};
  if (has(channels, "position"))
    return fail(ErrorKind::usage, "a nominal position is not possible, because there is a position channel",
                "--speed", "omit one of them");
  if (has(channels, "speed"))
    return fail(ErrorKind::usage,
                "a nominal position is not possible, because a speed channel is integrated to a position",
                "--speed", "omit one of them");
  if (*request.speed_mps == 0)
    return fail(ErrorKind::usage, "with a speed of 0 there is no position", "--speed");
  return {};
}

bool is_date(const std::string& text) {
  constexpr std::string_view kShape = "dddd-dd-dd";
  if (text.size() != kShape.size()) return false;
  for (std::size_t i = 0; i < kShape.size(); ++i)
    if (kShape[i] == 'd' ? text[i] < '0' || text[i] > '9' : text[i] != '-') return false;
  const auto number = [&](std::size_t from, std::size_t size) { return std::stoi(text.substr(from, size)); };
  const auto month = static_cast<unsigned>(number(5, 2)), day = static_cast<unsigned>(number(8, 2));
  return std::chrono::year_month_day(std::chrono::year(number(0, 4)), std::chrono::month(month),
                                     std::chrono::day(day))
      .ok();
}

Result<void> check_date(const std::string& text, const std::string& option) {
  if (text.empty() || is_date(text)) return {};
  return fail(ErrorKind::usage, fmt::format("'{}' is not a date", text), option, "write it as 2026-03-14");
}

Result<void> check_metadata(const ImportRequest& request) {
  const auto percent = request.humidity_percent.value_or(0);
  if (!(percent >= 0 && percent <= 100))
    return fail(ErrorKind::usage, fmt::format("{:g} % is not a relative humidity", percent), "--humidity",
                "give 0% to 100%");
  if (const auto recorded = check_date(request.recorded, "--date"); !recorded) return recorded;
  return check_date(request.calibrated, "--calibrated");
}

// Its name if it is unique, otherwise its number.
std::string typed_stream(const Source& source, const schema::XdfStream& stream) {
  const auto& all = source.xdf->streams;
  const bool unique = std::ranges::count(all, stream.name, &schema::XdfStream::name) == 1;
  return unique && !stream.name.empty() ? in_quotes(stream.name) : std::to_string(stream.id);
}

Result<void> check_stream(const ImportRequest& request, const Source& source) {
  if (!request.stream.empty() && !source.xdf)
    return fail(ErrorKind::usage, "is for XDF files", "--stream", "omit it: this is another file");
  if (!source.xdf || source.xdf_stream) return {};
  std::string names;
  for (const schema::XdfStream& stream : source.xdf->streams)
    if (stream.refusal.empty())
      names += (names.empty() ? "--stream " : " or --stream ") + typed_stream(source, stream);
  if (!names.empty())
    return fail(ErrorKind::usage, "has several streams", source.file, "choose one: " + names);
  return fail(ErrorKind::unsuitable, "has no stream of numbers", source.file,
              "see what it has with 'tactograph import FILE', without other options");
}

Result<void> check_without_source(const ImportRequest& request) {
  if (const auto rate = check_rate(request.rate_hz); !rate) return rate;
  return check_metadata(request);
}

Result<void> check_with_source(const ImportRequest& request, const ImportPlan& plan) {
  if (const auto clock = check_clock(request, plan.source); !clock) return clock;
  if (const auto speed = check_speed(request, plan.channels); !speed) return speed;
  return check_output(request);
}

}  // namespace

Result<ImportPlan> plan_import(const ImportRequest& request) {
  TACTO_TRY(check_without_source(request));
  auto source = open_source(request.file, request.skip_lines, request.stream);
  TACTO_TRY(source);
  TACTO_TRY(check_stream(request, *source));
  TACTO_TRY(check_refused(request, *source));
  auto channels = choose_channels(request, *source);
  TACTO_TRY(channels);
  ImportPlan plan{std::move(*source), std::move(*channels), std::nullopt};
  TACTO_TRY(check_with_source(request, plan));
  if (request.time_column.empty()) return plan;
  const auto time = parse_scaled_column(request.time_column, schema::Dimension::time,
                                        {plan.source.columns, plan.source.units});
  TACTO_TRY(time);
  plan.time = *time;
  return plan;
}

Result<void> check_rate_of_times(double rate_hz, const std::string& file) {
  if (is_storable(rate_hz)) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("its times give a rate of {:.4g} Hz: that of a recording is 1 Hz to 2 GHz", rate_hz), file,
      "check the unit of the times, for example --time-column 't*1ms'; or give --rate");
}

std::string example_options(const Source& source) {
  const std::string clock = source.rate_hz || source.xdf ? ""
                            : time_column_of(source)     ? clock_example(source) + " "
                                                         : "--rate 10kHz ";
  return clock + channels_example(source);
}

std::optional<std::size_t> time_column_of(const Source& source) {
  return column_in(source, schema::Dimension::time);
}

std::vector<std::size_t> columns_of(const ImportPlan& plan) {
  std::set<std::size_t> columns;
  for (const ChannelSpec& channel : plan.channels) columns.insert(channel.source.column);
  if (plan.time) columns.insert(plan.time->column);
  return {columns.begin(), columns.end()};
}

}  // namespace tacto::capture
