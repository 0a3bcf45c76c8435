// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/stroke_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "data-schema/quantity.hpp"
#include "playback/daemon/block_judge.hpp"
#include "playback/daemon/session_limits.hpp"

namespace tacto::playback {
namespace {

using schema::Result;

// What the band's filters leave beside a texture is no wish.
constexpr double kLeastWantedM = 1e-12;

bool nothing_was_wanted(const StrokeSums& sums) {
  return sums.known && sums.wanted_m2 < kLeastWantedM * kLeastWantedM * static_cast<double>(sums.rows);
}

PlayedStroke stroke_of(const StrokeSums& sums) {
  const auto rms = [&](double sum) { return std::sqrt(sum / static_cast<double>(sums.rows)); };
  PlayedStroke stroke;
  stroke.from_s = sums.first.row.time_s, stroke.to_s = sums.last.row.time_s;
  stroke.from_m = sums.first.row.position_m, stroke.to_m = sums.last.row.position_m;
  stroke.received_rms_m = rms(sums.received_m2);
  stroke.limited_ticks = sums.limited_ticks;
  stroke.energy_limited_ticks = sums.energy_limited_ticks;
  stroke.gated_ticks = sums.gated_ticks;
  if (sums.wishes_known) stroke.limits = sums.limits;
  if (!sums.known) return stroke;
  if (nothing_was_wanted(sums)) return stroke;
  stroke.wanted_rms_m = rms(sums.wanted_m2);
  stroke.error_db = 20 * std::log10(rms(sums.difference_m2) / stroke.wanted_rms_m);
  stroke.level_db = 20 * std::log10(stroke.received_rms_m / stroke.wanted_rms_m);
  return stroke;
}

std::string note_of_stops(const SessionOverview& overview) {
  return fmt::format(
      "{} ticks were never made, for the computer stood still; {} stops were longer than 10 ms: "
      "strokes end there",
      overview.missing_periods, overview.stops);
}

std::string note_of_loss(const SessionOverview& overview) {
  return fmt::format(
      "{} ticks are missing, from tick {} on: only strokes that end before it are judged, for what "
      "the device knew after it is not known",
      overview.lost, *overview.lost_at);
}

std::string note_of_blindness(const SessionOverview& overview) {
  return fmt::format(
      "in {} ticks no count of the encoder had come for 10 ms, and the drive fell: strokes end there, "
      "and the way until the next count is not judged",
      overview.blind_ticks);
}

StrokeReport begun_report(const SessionOverview& overview) {
  StrokeReport report;
  report.low_hz = overview.header.low_hz, report.high_hz = overview.header.high_hz;
  report.damaged = overview.damaged_at.has_value();
  if (!overview.closed && !report.damaged)
    report.notes.emplace_back("the session was never closed: what is in it is told");
  if (report.damaged)
    report.notes.push_back(
        fmt::format("{} is damaged from byte {} on: what comes after it is not in the report", overview.path,
                    *overview.damaged_at));
  if (!overview.not_uploaded.empty() && !report.damaged)
    report.notes.push_back(
        fmt::format("{} lacks {}: the disk did not take it (was it full?), and `replay` can't "
                    "compute its drive again",
                    overview.path, overview.not_uploaded));
  if (overview.lost_at)
    report.notes.push_back(note_of_loss(overview));
  else if (overview.missing_periods > 0)
    report.notes.push_back(note_of_stops(overview));
  if (overview.blind_ticks > 0) report.notes.push_back(note_of_blindness(overview));
  return report;
}

// No stroke is an answer, too, but not without its reason.
std::string note_of_none(const StrokeFinder& strokes, bool lost) {
  if (lost) return "no stroke ends before it";
  if (strokes.played() == 0) return "nothing was played: there is no stroke to judge";
  const double longest_m = strokes.longest_way_m();
  return fmt::format(
      "no stroke: the finger's longest way without turning, while playing, is {}, and a stroke is at least "
      "{}",
      longest_m > 0 ? schema::length_for_people(longest_m) : "under 0.2 mm",
      schema::length_for_people(kShortestStrokeM));
}

std::string note_of_unwanted(std::uint64_t unwanted, std::uint64_t all) {
  return fmt::format(
      "in {} of {} strokes nothing was wanted: no texture of the session lies where the finger went, or "
      "those "
      "that do cancel each other, so there is no wanted RMS and no error to tell",
      unwanted, all);
}

void keep_stroke(const PlayedStroke& stroke, const StrokeListener& listener, StrokeReport& report) {
  ++report.stroke_count;
  if (report.strokes.size() < kMostStrokesKept) report.strokes.push_back(stroke);
  if (listener.stroke) listener.stroke(stroke);
}

}  // namespace

Result<StrokeReport> report_strokes(const std::string& name, const StrokeListener& listener,
                                    const JudgedBlocks& blocks) {
  const auto overview = session_overview(name, part_of(listener.progress, 0, 0.1));
  if (!overview) return schema::forward_error(overview);
  StrokeReport report = begun_report(*overview);
  const std::uint64_t end = overview->lost_at.value_or(UINT64_MAX);
  if (end == 0) return report;
  LimitTally whole;
  std::uint64_t unwanted = 0;
  BlockJudge judge(*overview, blocks, [&](const StrokeSums& sums) {
    unwanted += nothing_was_wanted(sums);
    keep_stroke(stroke_of(sums), listener, report);
  });
  const auto each = [&](const schema::SessionTick& tick, std::optional<float> wished_v) {
    if (wished_v) whole.add(limited_tick(tick.drive_v, *wished_v, tick.flags));
    if (tick.tick < end) judge.take(tick, wished_v);
  };
  const auto unknown = hear_every_wish(name, each, part_of(listener.progress, 0.1, 1));
  if (!unknown) return schema::forward_error(unknown);
  judge.finish(overview->lost_at ? LastWay::cut : LastWay::whole);
  const auto notes = report.stroke_count > 0 ? judge.notes() : std::vector<std::string>();
  report.notes.insert(report.notes.end(), notes.begin(), notes.end());
  if (report.stroke_count == 0)
    report.notes.push_back(note_of_none(judge.strokes(), overview->lost_at.has_value()));
  if (unwanted > 0) report.notes.push_back(note_of_unwanted(unwanted, report.stroke_count));
  if (*unknown) report.notes.push_back(schema::message(**unknown));
  if (!*unknown) report.limits = whole;
  return report;
}

}  // namespace tacto::playback
