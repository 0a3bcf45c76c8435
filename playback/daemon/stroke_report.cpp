// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/stroke_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "data-schema/files.hpp"
#include "data-schema/statistics.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/chain.hpp"
#include "playback/choices.hpp"
#include "playback/daemon/session_columns.hpp"
#include "playback/daemon/session_limits.hpp"
#include "playback/daemon/session_wanted.hpp"
#include "playback/hysteresis_inverse.hpp"
#include "playback/reference/wanted.hpp"

namespace tacto::playback {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;

constexpr double kShortestStrokeM = 5e-3;
constexpr double kTurnM = 0.2e-3;  // a finger that goes back by less has not turned

bool plays(const SessionColumns& columns, std::size_t i) {
  return (columns.flags[i] & wire::kTickPlaying) != 0;
}

double duration_s(const SessionColumns& columns) {
  return static_cast<double>(columns.tick.size() - 1) / columns.header.rate_hz;
}

// Older sessions tell of no filter behind the converter. Words of a newer version: as if there was none.
Chain chain_of(const schema::SessionHeader& header) {
  const PrepareOptions played = with_choices({}, header.choices).value_or(PrepareOptions{});
  return {header.transducer, played.reconstruction, played.reconstruction_cutoff_hz, played.hold,
          header.rate_hz};
}

double rms_in(std::span<const double> values, const StrokeRange& range) {
  return schema::statistics_of(values.subspan(range.first, range.last - range.first + 1)).rms();
}

void count_limited(PlayedStroke& stroke, std::span<const std::uint32_t> flags) {
  for (const std::uint32_t tick : flags) {
    stroke.limited_ticks += (tick & (wire::kTickAmplitudeLimited | wire::kTickSlewLimited)) != 0;
    stroke.energy_limited_ticks += (tick & wire::kTickEnergyLimited) != 0;
    stroke.gated_ticks += (tick & wire::kTickGated) != 0;
  }
}

PlayedStroke stroke_of(const SessionColumns& columns, const StrokeRange& range,
                       std::span<const double> wanted, const std::vector<double>& received) {
  PlayedStroke stroke;
  stroke.from_s = columns.time_s[range.first], stroke.to_s = columns.time_s[range.last];
  stroke.from_m = columns.position_m[range.first], stroke.to_m = columns.position_m[range.last];
  stroke.received_rms_m = rms_in(received, range);
  count_limited(stroke, std::span(columns.flags).subspan(range.first, range.last - range.first + 1));
  if (wanted.empty()) return stroke;
  std::vector<double> difference(received.size());
  std::ranges::transform(received, wanted, difference.begin(), std::minus<>());
  stroke.wanted_rms_m = rms_in(wanted, range);
  stroke.error_db = 20 * std::log10(rms_in(difference, range) / stroke.wanted_rms_m);
  stroke.level_db = 20 * std::log10(stroke.received_rms_m / stroke.wanted_rms_m);
  return stroke;
}

// Rows that were put in were no ticks.
LimitTally tally_rows(const SessionColumns& columns, const StrokeRange& range,
                      std::span<const float> wished_v) {
  LimitTally tally;
  for (std::size_t i = range.first; i <= range.last; ++i) {
    const bool put_in = i > range.first && columns.tick[i] == columns.tick[i - 1];
    const auto drive_v = static_cast<float>(columns.drive_v[i]);
    if (!put_in) tally.add(limited_tick(drive_v, wished_v[columns.tick[i]], columns.flags[i]));
  }
  return tally;
}

void tell_limits(const std::string& name, const SessionColumns& columns, StrokeReport& report) {
  std::vector<float> wished_v;
  LimitTally whole;
  const auto heard = hear_wishes(name, [&](const schema::SessionTick& tick, float v) {
    wished_v.push_back(v);
    whole.add(limited_tick(tick.drive_v, v, tick.flags));
  });
  if (!heard) return report.notes.push_back(schema::message(heard.error()));
  report.limits = whole;
  const auto ranges = stroke_ranges(columns);
  for (std::size_t i = 0; i < report.strokes.size(); ++i)
    report.strokes[i].limits = tally_rows(columns, ranges[i], wished_v);
}

bool is_known(const SessionWanted& wanted, const StrokeRange& range) {
  const auto first = wanted.unknown.begin() + static_cast<std::ptrdiff_t>(range.first);
  const auto end = wanted.unknown.begin() + static_cast<std::ptrdiff_t>(range.last) + 1;
  return std::find(first, end, true) == end;
}

std::string note_of_stops(const EvenColumns& even) {
  return fmt::format(
      "{} ticks were never made, for the computer stood still; {} stops were longer than 10 ms: "
      "strokes end there",
      even.added, even.stops);
}

}  // namespace

// The farthest place so far in a direction ends a stroke once the finger has gone back from it.
std::vector<StrokeRange> stroke_ranges(const SessionColumns& columns) {
  const std::vector<double>& x = columns.position_m;
  std::vector<StrokeRange> ranges;
  std::size_t start = 0, farthest = 0;
  int direction = 0;
  const auto end_stroke = [&](std::size_t next) {
    if (std::abs(x[farthest] - x[start]) >= kShortestStrokeM) ranges.push_back({start, farthest});
    start = next;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!plays(columns, i)) {
      if (direction != 0) end_stroke(i);
      direction = 0, start = farthest = i;
      continue;
    }
    const double ahead = x[i] - x[farthest];
    if (direction == 0 && std::abs(x[i] - x[start]) > kTurnM) direction = x[i] > x[start] ? 1 : -1;
    if (direction == 0 || direction * ahead >= 0) {
      farthest = direction == 0 ? farthest : i;
    } else if (-direction * ahead > kTurnM) {
      end_stroke(farthest);
      direction = -direction, farthest = i;
    }
  }
  if (direction != 0) end_stroke(farthest);
  return ranges;
}

std::vector<double> received_displacement_m(const SessionColumns& columns) {
  const schema::SessionHeader& header = columns.header;
  const spatial::Band band{header.low_hz, header.high_hz};
  const ReadingGrid grid = reading_grid(duration_s(columns), header.rate_hz, band, 0);
  const Chain chain = chain_of(header);
  const schema::Transducer& t = header.transducer;
  const std::vector<double> linear =
      t.hysteresis
          ? linear_drive_of(columns.drive_v, *t.hysteresis, schema::actuator_pole_hz(t), header.rate_hz)
          : columns.drive_v;
  auto drive = spectrum_of(linear, header.rate_hz, grid.period);
  keep_band(drive, band);
  // A drive that was made elsewhere is felt later than the tick that it was made in.
  return signal_of(through(drive, [&](double f) {
    return chain_response(chain, f) * std::polar(1.0, -2 * std::numbers::pi * f * header.loop_delay_s);
  }));
}

void judge_strokes(const SessionColumns& columns, StrokeReport& report) {
  const auto ranges = stroke_ranges(columns);
  if (ranges.empty()) return;
  const SessionWanted wanted = wanted_in(columns);
  report.notes.insert(report.notes.end(), wanted.notes.begin(), wanted.notes.end());
  const auto received = received_displacement_m(columns);
  for (const StrokeRange& range : ranges) {
    const bool judged = is_known(wanted, range);
    report.strokes.push_back(stroke_of(
        columns, range, judged ? std::span(wanted.displacement_m) : std::span<const double>(), received));
  }
}

Result<StrokeReport> report_strokes(const std::string& name) {
  const auto columns = read_session_columns(name);
  if (!columns) return schema::forward_error(columns);
  StrokeReport report;
  report.low_hz = columns->header.low_hz, report.high_hz = columns->header.high_hz;
  report.damaged = columns->damaged_at.has_value();
  if (!columns->closed && !report.damaged)
    report.notes.emplace_back("the session was never closed: what is in it is told");
  if (report.damaged)
    report.notes.push_back(
        fmt::format("{} is damaged from byte {} on: what comes after it is not in the report",
                    schema::session_path(name), *columns->damaged_at));
  if (columns->lost_at) {
    report.notes.push_back(fmt::format("{} ticks are missing: strokes are not judged", columns->lost));
    return report;
  }
  const auto even = evened(*columns);
  if (!even) return schema::forward_error(even);
  if (even->added > 0) report.notes.push_back(note_of_stops(*even));
  judge_strokes(even->columns, report);
  tell_limits(name, even->columns, report);
  return report;
}

}  // namespace tacto::playback
