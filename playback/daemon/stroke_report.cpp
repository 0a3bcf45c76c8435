// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/stroke_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/files.hpp"
#include "data-schema/statistics.hpp"
#include "data-schema/texture.hpp"
#include "data-schema/texture_wav.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/chain.hpp"
#include "playback/choices.hpp"
#include "playback/daemon/played_ends.hpp"
#include "playback/daemon/session_columns.hpp"
#include "playback/hysteresis_inverse.hpp"
#include "playback/reference/spatial_content.hpp"
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

// Where the count changes the finger is between the two, half a tick ago; until the next change it goes on
// from there. The counts themselves are a staircase, which nobody wanted to be felt.
FingerPath path_of(const SessionColumns& columns) {
  const std::vector<double>& x = columns.position_m;
  FingerPath path{{0}, {x.front()}};
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] == x[i - 1]) continue;
    path.time_s.push_back((static_cast<double>(i) - 0.5) / columns.header.rate_hz);
    path.position_m.push_back(0.5 * (x[i - 1] + x[i]));
  }
  path.time_s.push_back(std::max(duration_s(columns), 0.5 / columns.header.rate_hz));
  path.position_m.push_back(path.position_m.back());
  if (path.position_m.size() > 2) path.position_m.front() = path.position_m[1];
  return path;
}

Result<schema::Texture> same_texture(const schema::SessionTexture& played) {
  auto texture = schema::read_texture(played.file);
  if (!texture) return texture;
  const auto wav = schema::texture_wav(played.file);
  if (wav && wav->sha256 == played.sha256) return texture;
  return fail(Fault::unsuitable, "is not what was played any more", played.file);
}

// Older sessions tell of no filter behind the converter. Words of a newer version: as if there was none.
Chain chain_of(const schema::SessionHeader& header) {
  const PrepareOptions played = with_choices({}, header.choices).value_or(PrepareOptions{});
  return {header.transducer, played.reconstruction, played.reconstruction_cutoff_hz, played.hold,
          header.rate_hz};
}

struct Judge {
  const SessionColumns& columns;
  spatial::Band band;
  FingerPath path;
  explicit Judge(const SessionColumns& session)
      : columns(session), band{session.header.low_hz, session.header.high_hz}, path(path_of(session)) {}

  Result<std::vector<double>> wanted_m() {
    std::vector<double> sum(columns.tick.size(), 0.0);
    const double fastest_mps = greatest_speed_mps(path);
    for (const schema::SessionTexture& played : columns.header.textures) {
      const auto texture = same_texture(played);
      if (!texture) return schema::forward_error(texture);
      const auto [nearest, farthest] = std::ranges::minmax_element(path.position_m);
      const auto signal = as_played(*texture, played, *nearest, *farthest);
      if (!signal) return schema::forward_error(signal);
      const double finest_hz = fastest_mps * highest_spatial_frequency(texture->signal);
      const ReadingGrid fine = reading_grid(path.duration_s(), columns.header.rate_hz, band, finest_hz);
      const TextureLookup lookup(signal->signal, signal->at_m);
      const auto values = signal_of(exact_wanted(lookup, path, fine, band, played.gain_m_per_n, 0));
      for (std::size_t i = 0; i < std::min(sum.size(), values.size()); ++i)
        sum[i] += columns.gain[i] * values[i];
    }
    return sum;
  }
};

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

// The session's header knows the texture that it began with.
bool is_of_first_texture(const SessionColumns& columns, const StrokeRange& range) {
  return !columns.changed_at || range.last < *columns.changed_at;
}

std::string note_of_stops(const EvenColumns& even) {
  return fmt::format(
      "{} ticks were never made, for the computer stood still; {} stops were longer than 10 ms: "
      "strokes end there",
      even.added, even.stops);
}

std::string note_of_change(const SessionColumns& columns) {
  return fmt::format("the texture changes at {:.3f} s: strokes that reach beyond are not judged",
                     columns.time_s[*columns.changed_at]);
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
  return signal_of(through(drive, [&](double f) { return chain_response(chain, f); }));
}

void judge_strokes(const SessionColumns& columns, StrokeReport& report) {
  if (columns.changed_at) report.notes.push_back(note_of_change(columns));
  const auto ranges = stroke_ranges(columns);
  if (ranges.empty()) return;
  Judge judge(columns);
  const auto wanted = judge.wanted_m();
  if (!wanted) report.notes.push_back(schema::message(wanted.error()));
  const auto received = received_displacement_m(columns);
  for (const StrokeRange& range : ranges) {
    const bool judged = wanted && is_of_first_texture(columns, range);
    report.strokes.push_back(
        stroke_of(columns, range, judged ? std::span(*wanted) : std::span<const double>(), received));
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
  return report;
}

}  // namespace tacto::playback
