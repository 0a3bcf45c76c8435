// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/stroke_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "data-schema/base/decibels.hpp"
#include "data-schema/base/lagrange.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/stroke_rule.hpp"
#include "firmware-host/core/firmware/encoder_watch.hpp"
#include "playback/session/session_limits.hpp"
#include "playback/strokes/block_judge.hpp"
#include "playback/strokes/session_target.hpp"
#include "spatial/features/band_kept.hpp"

namespace tacto::playback {
namespace {

using schema::Result;

// Below it the target is only the residue of the band's filters outside a texture.
constexpr double kLeastTargetM = 1e-12;

bool target_is_zero(const StrokeSums& sums) {
  return sums.known && sums.target_m2 < kLeastTargetM * kLeastTargetM * static_cast<double>(sums.rows);
}

double over_db(double value_m, double of_m) {
  return schema::amplitude_db(value_m / of_m);
}

// The polynomial through the five values around the minimum, at `u` steps from the middle one: its error for
// a signal sampled 24 times per period of 500 Hz is below 2e-6 of the measured value (Lagrange).
double between_five(const std::array<double, 5>& e, double u) {
  return schema::lagrange({-2, -1, 0, 1, 2}, e, u);
}

struct LeastError {
  double shift = 0, difference_m2 = 0;  // in steps from the first
};

// To a hundredth of a step: the remaining 1 us gives at most -52 dB at 500 Hz.
LeastError least_error(const std::array<double, kShifts>& difference_m2) {
  constexpr int kParts = 100;
  const auto least = std::ranges::min_element(difference_m2) - difference_m2.begin();
  const auto middle = std::clamp<std::ptrdiff_t>(least, 2, kShifts - 3);
  std::array<double, 5> around{};
  std::copy_n(difference_m2.begin() + (middle - 2), around.size(), around.begin());
  LeastError found{static_cast<double>(least), difference_m2[static_cast<std::size_t>(least)]};
  for (int part = -2 * kParts; part <= 2 * kParts; ++part) {
    const double u = static_cast<double>(part) / kParts, difference = between_five(around, u);
    if (difference < found.difference_m2) found = {static_cast<double>(middle) + u, difference};
  }
  return {found.shift, std::max(found.difference_m2, 0.0)};
}

StrokeDisplacement displacement_of(const ShiftedSums& sums, std::uint64_t rows, double target_rms_m) {
  const auto rms = [&](double sum) { return std::sqrt(sum / static_cast<double>(rows)); };
  StrokeDisplacement displacement;
  displacement.rms_m = rms(sums.displacement_m2);
  if (target_rms_m == 0) return displacement;
  LeastError least = least_error(sums.difference_m2);
  if (least.shift > 0 && least.shift < kShifts - 1)
    displacement.shift_s = shift_s_at(least.shift);
  else
    least.difference_m2 = sums.difference_m2[kUnshifted];
  displacement.error_db = over_db(rms(least.difference_m2), target_rms_m);
  displacement.level_db = over_db(displacement.rms_m, target_rms_m);
  return displacement;
}

PlayedStroke stroke_of(const StrokeSums& sums) {
  const auto rms = [&](double sum) { return std::sqrt(sum / static_cast<double>(sums.rows)); };
  PlayedStroke stroke;
  stroke.from_s = sums.first.row.time_s, stroke.to_s = sums.last.row.time_s;
  stroke.from_m = sums.first.row.position_m, stroke.to_m = sums.last.row.position_m;
  stroke.limited_ticks = sums.limited_ticks;
  stroke.energy_limited_ticks = sums.energy_limited_ticks;
  stroke.gated_ticks = sums.gated_ticks;
  if (sums.unlimited_known) stroke.limits = sums.limits;
  if (sums.known && !target_is_zero(sums)) stroke.target_rms_m = rms(sums.target_m2);
  stroke.predicted = displacement_of(sums.predicted, sums.rows, stroke.target_rms_m);
  if (sums.measured_known) stroke.measured = displacement_of(sums.measured, sums.rows, stroke.target_rms_m);
  return stroke;
}

std::string note_of_stops(const SessionOverview& overview) {
  return fmt::format(
      "{} periods have no tick because the computer stopped; {} stops were longer than 10 ms: strokes end "
      "there",
      overview.missing_periods, overview.stops);
}

std::string note_of_loss(const SessionOverview& overview) {
  return fmt::format(
      "{} ticks are missing, from tick {} on: only strokes that end before it are judged, because the "
      "device's later state is unknown",
      overview.lost, *overview.lost_at);
}

std::string note_of_blindness(const SessionOverview& overview) {
  return fmt::format(
      "in {} ticks no encoder count had come for {}, and the drive fell: strokes end there, and the "
      "motion until the next count is not judged",
      overview.blind_ticks, schema::for_people(double{core::kBlindS}, schema::Dimension::time));
}

StrokeReport begun_report(const SessionOverview& overview) {
  StrokeReport report;
  report.low_hz = overview.header.low_hz, report.high_hz = overview.header.high_hz;
  report.damaged = overview.damaged_at.has_value();
  report.last_gain = overview.header.initial_gain;
  for (const SteeringStep& step : overview.steps) report.last_gain = step.gain.value_or(report.last_gain);
  if (!overview.closed && !report.damaged)
    report.notes.emplace_back("the session was never closed: the figures are of the part that was stored");
  if (report.damaged)
    report.notes.push_back(
        fmt::format("{} is damaged from byte {} on: the part after it is not in the report", overview.path,
                    *overview.damaged_at));
  if (!overview.not_uploaded.empty() && !report.damaged)
    report.notes.push_back(
        fmt::format("{} lacks {}: it could not be written (was the disk full?), so `replay` can't compute "
                    "its drive again",
                    overview.path, overview.not_uploaded));
  if (overview.lost_at)
    report.notes.push_back(note_of_loss(overview));
  else if (overview.missing_periods > 0)
    report.notes.push_back(note_of_stops(overview));
  if (overview.blind_ticks > 0) report.notes.push_back(note_of_blindness(overview));
  return report;
}

// If there is no stroke, the report states the reason.
std::string note_of_none(const StrokeFinder& strokes, bool lost) {
  if (lost) return "no stroke ends before it";
  if (strokes.played() == 0) return "nothing was played: there is no stroke to judge";
  const double longest_m = strokes.longest_way_m();
  return fmt::format(
      "no stroke: the finger's longest motion in one direction during playback is {}, a stroke is at least "
      "{}",
      longest_m > 0 ? schema::length_for_people(longest_m) : "under 0.2 mm",
      schema::length_for_people(schema::kShortestStroke_m));
}

std::string note_of_no_target(std::uint64_t without_target, std::uint64_t all) {
  return fmt::format(
      "in {} of {} strokes the target is zero (no texture there, or textures that cancel each other): they "
      "have no target RMS and no error",
      without_target, all);
}

std::string note_of_unmeasured(std::uint64_t unmeasured, std::uint64_t all) {
  return fmt::format(
      "{} of {} strokes have no measured figures, because samples of the tray's sensor are missing within "
      "0.3 s of them",
      unmeasured, all);
}

void keep_stroke(const PlayedStroke& stroke, const StrokeListener& listener, StrokeReport& report) {
  ++report.stroke_count;
  if (report.strokes.size() < kMostStrokesKept) report.strokes.push_back(stroke);
  if (listener.stroke) listener.stroke(stroke);
}

class SpeedOfStrokes {
 public:
  void add(const StrokeSums& stroke) {
    length_m_ += std::abs(stroke.last.row.position_m - stroke.first.row.position_m);
    time_s_ += stroke.last.row.time_s - stroke.first.row.time_s;
  }

  StrokeSpeed of(const SessionOverview& overview) const {
    StrokeSpeed speed;
    if (!(time_s_ > 0)) return speed;
    speed.mean_mps = length_m_ / time_s_;
    const bool changed =
        std::ranges::any_of(overview.steps, [](const SteeringStep& step) { return step.turn.has_value(); });
    const schema::SessionHeader& header = overview.header;
    if (header.textures.size() != 1 || changed) return speed;
    if (const auto texture = same_texture(header.textures.front()))
      speed.power_kept_percent =
          spatial::band_kept_percent(*texture, speed.mean_mps, {header.low_hz, header.high_hz});
    return speed;
  }

 private:
  double length_m_ = 0, time_s_ = 0;
};

}  // namespace

Result<StrokeReport> report_strokes(const std::string& name, const StrokeListener& listener,
                                    const JudgedBlocks& blocks) {
  const auto overview = session_overview(name, part_of(listener.progress, 0, 0.1));
  TACTO_TRY(overview);
  StrokeReport report = begun_report(*overview);
  const std::uint64_t end = overview->lost_at.value_or(UINT64_MAX);
  if (end == 0) return report;
  LimitTally whole;
  std::uint64_t without_target = 0, unmeasured = 0;
  SpeedOfStrokes speed;
  BlockJudge judge(*overview, blocks, [&](const StrokeSums& sums) {
    without_target += target_is_zero(sums);
    unmeasured += !sums.measured_known;
    speed.add(sums);
    keep_stroke(stroke_of(sums), listener, report);
  });
  const auto each = [&](const schema::SessionTick& tick, std::optional<float> unlimited_v) {
    if (unlimited_v) whole.add(limited_tick(tick.drive_v, *unlimited_v, tick.flags));
    if (tick.tick < end) judge.take(tick, unlimited_v);
  };
  const auto unknown = read_unlimited_where_known(name, each, part_of(listener.progress, 0.1, 1));
  TACTO_TRY(unknown);
  judge.finish(overview->lost_at ? LastStroke::cut : LastStroke::whole);
  const auto notes = report.stroke_count > 0 ? judge.notes() : std::vector<std::string>();
  report.notes.insert(report.notes.end(), notes.begin(), notes.end());
  if (report.stroke_count == 0)
    report.notes.push_back(note_of_none(judge.strokes(), overview->lost_at.has_value()));
  if (without_target > 0) report.notes.push_back(note_of_no_target(without_target, report.stroke_count));
  if (overview->header.sensor && unmeasured > 0)
    report.notes.push_back(note_of_unmeasured(unmeasured, report.stroke_count));
  if (*unknown) report.notes.push_back(schema::message(**unknown));
  if (!*unknown) report.limits = whole;
  report.speed = speed.of(*overview);
  return report;
}

Result<StrokeSpeed> stroke_speed(const std::string& name) {
  const auto overview = session_overview(name);
  TACTO_TRY(overview);
  const std::uint64_t end = overview->lost_at.value_or(UINT64_MAX);
  if (end == 0) return StrokeSpeed{};
  SpeedOfStrokes speed;
  StrokeFinder finder([&](const StrokeSums& sums) { speed.add(sums); });
  RowMaker maker(*overview, 2 * rows_in(JudgedBlocks{}.around_s, overview->header.rate_hz));
  std::uint64_t index = 0;
  const auto read = read_rows(maker, name, [&](const SessionRow& row) {
    if (row.tick < end) finder.add({index++, row, 0, true, {}, {}, {}});
  });
  TACTO_TRY(read);
  if (!overview->lost_at) finder.end();
  return speed.of(*overview);
}

}  // namespace tacto::playback
