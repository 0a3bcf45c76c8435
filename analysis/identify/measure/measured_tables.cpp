// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/measured_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "analysis/identify/measure/number_table.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNoRadians = 100;  // sixteen turns; no transducer has such a phase

// A unit in lower case, as unit_in() gives it, in SI.
std::optional<double> worth(std::string_view unit, Dimension dimension) {
  const auto found = schema::unit_with_ending(fmt::format("_{}", unit));
  return found && found->dimension == dimension ? std::optional(found->si) : std::nullopt;
}

std::optional<double> worth(std::string_view unit, Dimension over, Dimension under) {
  const auto slash = unit.find('/');
  if (slash == unit.npos) return std::nullopt;
  const auto above = worth(unit.substr(0, slash), over), below = worth(unit.substr(slash + 1), under);
  return above && below ? std::optional(*above / *below) : std::nullopt;
}

std::optional<double> hertz_of(std::string_view unit) {
  if (unit.empty()) return 1;
  return unit == "rad/s" ? 0.5 / std::numbers::pi : worth(unit, Dimension::frequency);
}

// The unit behind the name: "Gain (dB um/V)" after "gain": "db um/v"; "_um_per_v": "um/v".
std::string unit_in(std::string_view behind) {
  std::string unit;
  for (std::size_t i = 0; i < behind.size(); ++i) {
    const char c = static_cast<char>(std::tolower(static_cast<unsigned char>(behind[i])));
    if (behind.substr(i).starts_with("_per_"))
      unit += '/', i += 4;
    else if (behind.substr(i).starts_with("\xC2\xB5") || behind.substr(i).starts_with("\xCE\xBC"))
      unit += 'u', ++i;
    else if (c == '_')
      unit += ' ';
    else if (std::string_view("()[]").find(c) == std::string_view::npos)
      unit += c;
  }
  const auto first = unit.find_first_not_of(' ');
  return first == std::string::npos ? "" : unit.substr(first, unit.find_last_not_of(' ') - first + 1);
}

// A column, found by the beginning of its name.
struct Found {
  std::size_t index = 0;
  std::string unit;
};

std::optional<Found> column(const NumberTable& table, std::initializer_list<std::string_view> names) {
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    std::string name = table.names[i];
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const std::string_view target : names)
      if (name.starts_with(target))
        return Found{i, unit_in(std::string_view(table.names[i]).substr(target.size()))};
  }
  return std::nullopt;
}

tl::unexpected<schema::Error> no_column(const std::string& path, std::string_view what) {
  return fail(ErrorKind::malformed, fmt::format("it has no column of {}", what), path,
              "name the columns in the first line: frequency_hz,amplitude_um_per_v,phase_deg, or "
              "drive_v,displacement_um");
}

struct AmplitudeUnit {
  Direction direction = Direction::actuator;
  double si = 1;
  bool decibels = false;
};

Result<AmplitudeUnit> amplitude_unit(std::string unit, const std::string& path) {
  AmplitudeUnit found;
  found.decibels = unit.starts_with("db ");
  if (found.decibels) unit = unit.substr(3);
  if (const auto si = worth(unit, Dimension::length, Dimension::voltage))
    found.si = *si;
  else if (const auto volts = worth(unit, Dimension::voltage, Dimension::force))
    found = {Direction::sensor, *volts, found.decibels};
  else
    return fail(
        ErrorKind::usage,
        unit.empty() ? "the amplitude has no unit" : fmt::format("'{}' is not a unit of amplitude", unit),
        path,
        "write amplitude_um_per_v (or m, mm, nm) or amplitude_v_per_n into the header, or give "
        "--amplitude-unit um/V, V/N or \"dB m/V\"");
  return found;
}

Result<double> phase_unit(const std::string& unit, const std::string& path) {
  if (unit == "deg" || unit == "degrees" || unit == "\xC2\xB0") return kDegree;
  if (unit == "rad" || unit == "radians") return 1.0;
  return fail(ErrorKind::usage,
              unit.empty() ? "the phase has no unit" : fmt::format("'{}' is no unit of phase", unit), path,
              "write phase_deg or phase_rad into the header, or give --phase-unit deg");
}

Result<void> check_radians(const NumberTable& table, std::size_t phase, const std::string& path) {
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (std::abs(table.at(row, phase)) > kNoRadians)
      return fail(ErrorKind::unsuitable,
                  fmt::format("a phase of {:g} rad: these are probably degrees", table.at(row, phase)), path,
                  "write phase_deg, or give --phase-unit deg");
  return {};
}

// If all values are below 0: decibels of the unit without a prefix; if some are: of the usual unit.
std::string likely_decibels(Direction direction, bool all) {
  if (direction == Direction::sensor) return "dB V/N";
  return all ? "dB m/V" : "dB um/V";
}

// A magnitude cannot be negative, but a level in decibels can.
Result<void> check_sizes(const NumberTable& table, std::size_t amplitude, Direction direction,
                         const std::string& path) {
  std::size_t first = 0, below = 0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (table.at(row, amplitude) < 0 && ++below == 1) first = row;
  if (below == 0) return {};
  const std::string what = fmt::format("an amplitude of {:g}, below 0", table.at(first, amplitude)),
                    where = fmt::format("{}, line {}", path, table.lines[first]);
  if (below == 1)
    return fail(ErrorKind::unsuitable, what, where,
                "measure it again, or remove its line; a half turn belongs in the phase");
  return fail(ErrorKind::unsuitable,
              fmt::format("{}, as in {} of {} lines: these are probably decibels", what, below, table.rows()),
              where,
              fmt::format("give --amplitude-unit \"{}\"; a half turn belongs in the phase",
                          likely_decibels(direction, below == table.rows())));
}

std::string chosen(const std::string& asked, const std::string& found) {
  return asked.empty() ? found : unit_in(asked);
}

}  // namespace

Result<bool> is_bode_table(const std::string& path) {
  const auto names = table_names(path);
  TACTO_TRY(names);
  return column({*names, {}, {}}, {"freq", "f_hz"}).has_value();
}

Result<BodeData> read_bode_table(const std::string& path, const TableUnits& units) {
  const auto table = read_numbers(path);
  TACTO_TRY(table);
  const auto frequency = column(*table, {"frequency", "freq", "f_hz"});
  const auto amplitude = column(*table, {"amplitude", "gain", "magnitude"}),
             phase = column(*table, {"phase"});
  if (!frequency || !amplitude || !phase)
    return no_column(path, !frequency ? "frequency" : !amplitude ? "amplitude" : "phase");
  const auto unit = amplitude_unit(chosen(units.amplitude, amplitude->unit), path);
  TACTO_TRY(unit);
  const auto radians = phase_unit(chosen(units.phase, phase->unit), path);
  TACTO_TRY(radians);
  TACTO_TRY(*radians == 1 ? check_radians(*table, phase->index, path) : Result<void>());
  if (const auto sound =
          unit->decibels ? Result<void>() : check_sizes(*table, amplitude->index, unit->direction, path);
      !sound)
    return schema::forward_error(sound);
  const auto hertz = hertz_of(frequency->unit);
  if (!hertz)
    return fail(ErrorKind::usage, fmt::format("'{}' is not a unit of frequency", frequency->unit), path,
                "write frequency_hz, frequency_khz or frequency_rad_per_s into the header");
  const auto noise = column(*table, {"noise", "sigma"});
  BodeData data;
  data.direction = unit->direction;
  data.source = path;
  data.table_unit_si = unit->decibels ? 0 : unit->si;
  data.table_in_degrees = *radians == kDegree;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const double value = table->at(row, amplitude->index);
    const double size = unit->si * (unit->decibels ? schema::amplitude_of_db(value) : value);
    data.frequency_hz.push_back(*hertz * table->at(row, frequency->index));
    data.response.push_back(size * std::polar(1.0, *radians * table->at(row, phase->index)));
    if (noise && !unit->decibels) data.noise.push_back(unit->si * table->at(row, noise->index));
  }
  return data;
}

Result<DrivenTray> read_driven_table(const std::string& path) {
  const auto table = read_numbers(path);
  TACTO_TRY(table);
  const auto drive = column(*table, {"drive"}), displacement = column(*table, {"displacement"});
  if (!drive || !displacement) return no_column(path, !drive ? "drive" : "displacement");
  const auto volts = worth(drive->unit, Dimension::voltage),
             metres = worth(displacement->unit, Dimension::length);
  if (!volts || !metres)
    return fail(ErrorKind::usage, fmt::format("the {} has no unit", volts ? "displacement" : "drive"), path,
                "write drive_v,displacement_um (or m, mm, nm) into the first line");
  DrivenTray tray;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    tray.drive_v.push_back(*volts * table->at(row, drive->index));
    tray.displacement_m.push_back(*metres * table->at(row, displacement->index));
  }
  const auto time = column(*table, {"time"});
  if (!time || table->rows() < 2) return tray;
  const double step_s = (table->at(table->rows() - 1, time->index) - table->at(0, time->index)) /
                        static_cast<double>(table->rows() - 1);
  for (std::size_t row = 1; row < table->rows(); ++row)
    if (!(std::abs(table->at(row, time->index) - table->at(row - 1, time->index) - step_s) <= 0.01 * step_s))
      return fail(ErrorKind::unsuitable, "the times are not even", fmt::format("{}, row {}", path, row + 1),
                  "sample it again at one rate");
  tray.rate_hz = 1 / step_s;
  return tray;
}

// Clipped samples are refused: one clipped resonance caused a misfit of a good sensor.
Result<void> check_unclipped(const schema::Channel& channel, const std::vector<double>& values,
                             const std::string& stem) {
  const auto clipped = std::ranges::count_if(values, [&](double value) {
    return (channel.range_max && value >= *channel.range_max) ||
           (channel.range_min && value <= *channel.range_min);
  });
  if (clipped == 0) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("{} samples of {} are at an end of the converter's range", clipped, channel.name),
              stem, "use a smaller drive, and record again");
}

Result<RecordedPair> read_recorded_pair(const std::string& stem, const std::string& input,
                                        const std::string& output) {
  const auto recording = schema::open_recording(stem);
  TACTO_TRY(recording);
  const schema::RecordingHeader& header = recording->header;
  if (!header.gaps.empty())
    return fail(ErrorKind::unsuitable, "the recording has gaps", stem, "record it again without losses");
  RecordedPair pair;
  pair.rate_hz = header.sample_rate_hz;
  pair.simulated = header.simulated;
  for (const auto& [name, values] : {std::pair(&input, &pair.input), std::pair(&output, &pair.output)}) {
    const auto index = schema::find_channel(header, *name);
    TACTO_TRY(index);
    const auto signal = schema::read_channel(*recording, *index);
    TACTO_TRY(signal);
    *values = signal->values;
    TACTO_TRY(check_unclipped(header.channels[*index], *values, stem));
    if (header.channels[*index].quantity != "tangential_force" || !header.transducer) continue;
    const double newtons_per_volt = schema::nominal_newtons_per_volt(*header.transducer);
    for (double& value : *values) value /= newtons_per_volt;
    pair.direction = Direction::sensor;
  }
  return pair;
}

}  // namespace tacto::analysis
