// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>

#include "data-schema/command/output_options.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/warnings.hpp"
#include "data-schema/session/session_reader.hpp"
#include "playback/cli/play_reports.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/session/force_session.hpp"
#include "playback/session/session_export.hpp"
#include "playback/strokes/stroke_report.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Result;

namespace {

struct SessionVerbOptions {
  std::string session;
  std::vector<std::string> outputs;
  std::string strokes;
  schema::Existing existing = schema::Existing::keep;
};

constexpr std::string_view kStrokeColumns =
    "stroke,from_s,to_s,from_m,to_m,predicted_rms_m,target_rms_m,predicted_error_db,predicted_over_target_db,"
    "predicted_shift_s,removed_by_limits_db,limited_ticks,energy_limited_ticks,gated_ticks,measured_rms_m,"
    "measured_error_db,"
    "measured_over_target_db,measured_shift_s";

// Unknown values are left empty.
std::string stroke_line(std::uint64_t number, const PlayedStroke& s) {
  const auto cell = [](bool known, double value) { return known ? fmt::format("{:.9g}", value) : ""; };
  const bool judged = s.target_rms_m > 0, sensed = s.measured.has_value();
  const StrokeDisplacement measured = s.measured.value_or(StrokeDisplacement{});
  return fmt::format("{},{:.9f},{:.9f},{:.12g},{:.12g},{:.9g},{},{},{},{},{},{},{},{},{},{},{},{}\n", number,
                     s.from_s, s.to_s, s.from_m, s.to_m, s.predicted.rms_m, cell(judged, s.target_rms_m),
                     cell(judged, s.predicted.error_db), cell(judged, s.predicted.level_db),
                     cell(s.predicted.shift_s.has_value(), s.predicted.shift_s.value_or(0)),
                     cell(s.limits && s.limits->removed_any(), s.limits ? s.limits->removed_db() : 0),
                     s.limited_ticks, s.energy_limited_ticks, s.gated_ticks, cell(sensed, measured.rms_m),
                     cell(sensed && judged, measured.error_db), cell(sensed && judged, measured.level_db),
                     cell(measured.shift_s.has_value(), measured.shift_s.value_or(0)));
}

bool is_stroke_table(std::string_view line) {
  return line.starts_with("stroke,from_s,to_s,from_m,to_m,");
}

/// The strokes as a table, written as they are found.
class StrokeTable {
 public:
  Result<void> open(const std::string& file) {
    const auto temporary = pending_.add(file);
    TACTO_TRY(temporary);
    file_ = file;
    out_.open(*temporary, std::ios::binary);
    out_ << kStrokeColumns << '\n';
    return {};
  }
  void add(const PlayedStroke& stroke) {
    if (out_.is_open()) out_ << stroke_line(++strokes_, stroke);
  }
  Result<void> close(schema::Existing existing) {
    if (!out_.is_open()) return {};
    out_.flush();
    if (!out_)
      return schema::fail(schema::ErrorKind::cannot_write, "can't be written", file_, "is the disk full?");
    return pending_.commit(existing);
  }

 private:
  schema::PendingFiles pending_;
  std::string file_;
  std::ofstream out_;
  std::uint64_t strokes_ = 0;
};

void add_shift(Report& row, const std::string& key, const std::optional<double>& shift_s) {
  if (shift_s)
    row.add(key, *shift_s);
  else
    row.add(key, "not found");
}

Report stroke_row(const PlayedStroke& stroke) {
  Report row;
  const bool judged = stroke.target_rms_m > 0;
  row.add("from_s", stroke.from_s).add("to_s", stroke.to_s);
  row.add("from_m", stroke.from_m).add("to_m", stroke.to_m);
  row.add("predicted_rms_m", stroke.predicted.rms_m);
  if (judged) {
    row.add("target_rms_m", stroke.target_rms_m)
        .add("predicted_error_db", stroke.predicted.error_db)
        .add("predicted_over_target_db", stroke.predicted.level_db);
    add_shift(row, "predicted_shift_s", stroke.predicted.shift_s);
  }
  if (const auto& measured = stroke.measured) {
    row.add("measured_rms_m", measured->rms_m);
    if (judged) {
      row.add("measured_error_db", measured->error_db).add("measured_over_target_db", measured->level_db);
      add_shift(row, "measured_shift_s", measured->shift_s);
    }
  }
  if (stroke.limits && stroke.limits->removed_any())
    row.add("removed_by_limits_db", stroke.limits->removed_db());
  return row.add("limited_ticks", stroke.limited_ticks)
      .add("energy_limited_ticks", stroke.energy_limited_ticks)
      .add("gated_ticks", stroke.gated_ticks);
}

Result<void> check_outputs(const SessionVerbOptions& o) {
  std::vector<std::string> all = o.outputs;
  if (!o.strokes.empty()) all.push_back(o.strokes);
  for (auto file = all.begin(); file != all.end(); ++file)
    if (std::any_of(all.begin(), file, [&](const auto& other) { return schema::same_file(*file, other); }))
      return schema::fail(schema::ErrorKind::usage, fmt::format("'{}' is named twice", *file), "output",
                          "give each table a different file");
  for (const std::string& output : o.outputs)
    if (auto free = check_session_output(output, o.existing); !free) return free;
  return o.strokes.empty() ? Result<void>{}
                           : schema::check_table_free(o.strokes, o.existing, is_stroke_table);
}

Result<void> export_all(const SessionVerbOptions& o) {
  for (const std::string& output : o.outputs) {
    cli::Progress progress("exporting " + output);
    const auto said =
        export_session(o.session, output, o.existing, [&](double part) { progress.update(part); });
    TACTO_TRY(said);
    if (!said->empty()) cli::warn(fmt::format("{}: {}", output, *said));
  }
  return {};
}

Result<StrokeReport> judge_all(const SessionVerbOptions& o) {
  StrokeTable table;
  if (!o.strokes.empty()) TACTO_TRY(table.open(o.strokes));
  cli::Progress progress("judging");
  auto report = report_strokes(o.session, {[&](const PlayedStroke& stroke) { table.add(stroke); },
                                           [&](double part) { progress.update(part); }});
  if (!report) return report;
  const auto closed = table.close(o.existing);
  return closed ? report : schema::forward_error(closed);
}

void warn_of(const StrokeReport& strokes) {
  cli::warn_grouped(strokes.notes);
  if (strokes.stroke_count > strokes.strokes.size())
    cli::warn(fmt::format("the first {} of {} strokes are shown; --strokes FILE.csv writes all",
                          strokes.strokes.size(), strokes.stroke_count));
}

// Adds states, faults, gains, changes of texture, and the clients' marks.
Result<void> add_events(Report& report, const std::string& session) {
  auto reader = schema::SessionReader::open(session);
  TACTO_TRY(reader);
  const schema::SessionTotals totals = session_totals(*reader);
  std::vector<Report> rows;
  for (const schema::SessionEvent& event : totals.events)
    rows.push_back(Report().add("tick", event.tick).add("event", event.text));
  if (totals.event_count > totals.events.size())
    report.add("events_left_out", totals.event_count - totals.events.size());
  report.add("events", std::move(rows));
  std::vector<Report> marks;
  for (const schema::SessionEvent& mark : totals.marks)
    marks.push_back(Report().add("tick", mark.tick).add("mark", mark.text));
  if (!marks.empty()) report.add("marks", std::move(marks));
  return {};
}

bool is_force_session_table(std::string_view line) {
  return line.starts_with("tick,time_s,") && line.find(",force_") != std::string_view::npos;
}

// Strokes and displacements belong to a tray.
Result<Report> run_force_session(const SessionVerbOptions& o) {
  if (!o.strokes.empty())
    return schema::fail(schema::ErrorKind::unsuitable, "is a session of forces: it has no strokes",
                        schema::session_path(o.session), "leave --strokes out");
  for (const std::string& output : o.outputs)
    if (!output.ends_with(".csv"))
      return schema::fail(schema::ErrorKind::usage, "a session of forces is exported as .csv", output);
  for (const std::string& output : o.outputs)
    TACTO_TRY(schema::check_table_free(output, o.existing, is_force_session_table));
  for (const std::string& output : o.outputs) {
    const auto note = export_force_session(o.session, output, o.existing);
    TACTO_TRY(note);
    if (!note->empty()) cli::warn(fmt::format("{}: {}", output, *note));
  }
  const auto session = read_force_session(o.session);
  TACTO_TRY(session);
  Report report;
  report.add("session", schema::session_path(o.session));
  if (!o.outputs.empty()) report.add("written", o.outputs);
  report.add("ticks", session->ticks).add("lost_ticks", session->lost);
  std::vector<Report> rows;
  for (const ForceSessionAxis& axis : session->axes)
    rows.push_back(Report()
                       .add("axis", axis.name)
                       .add("from_m", axis.from_m)
                       .add("to_m", axis.to_m)
                       .add("force_rms_n", axis.force_rms_n)
                       .add("force_peak_n", axis.force_peak_n));
  report.add("axes", std::move(rows));
  report.add("peak_limited_ticks", session->limits.amplitude)
      .add("slew_limited_ticks", session->limits.slew)
      .add("rms_limited_ticks", session->limits.energy);
  TACTO_TRY(add_events(report, o.session));
  if (session->damaged) report.ends_with(schema::ErrorKind::malformed);
  return report;
}

Result<Report> run_session(const SessionVerbOptions& o) {
  const auto reader = schema::SessionReader::open(o.session);
  TACTO_TRY(reader);
  if (reader->header().forces) return run_force_session(o);
  TACTO_TRY(check_outputs(o));
  TACTO_TRY(export_all(o));
  const auto strokes = judge_all(o);
  TACTO_TRY(strokes);
  warn_of(*strokes);
  std::vector<std::string> written = o.outputs;
  if (!o.strokes.empty()) written.push_back(o.strokes);
  Report report;
  report.add("session", schema::session_path(o.session));
  if (!written.empty()) report.add("written", written);
  report.add("band_low_hz", strokes->low_hz).add("band_high_hz", strokes->high_hz);
  add_removed(report, strokes->limits);
  if (strokes->limits) report.add("energy_limited_ticks", strokes->limits->energy_limited());
  report.add("stroke_count", strokes->stroke_count);
  const StrokeSpeed& speed = strokes->speed;
  if (speed.mean_mps > 0) report.add("mean_speed_mps", speed.mean_mps);
  if (speed.power_kept_percent) report.add("power_kept_percent", *speed.power_kept_percent);
  std::vector<Report> rows;
  for (const PlayedStroke& stroke : strokes->strokes) rows.push_back(stroke_row(stroke));
  report.add("strokes", std::move(rows));
  TACTO_TRY(add_events(report, o.session));
  if (strokes->damaged) report.ends_with(schema::ErrorKind::malformed);
  return report;
}

cli::Action declare_session(CLI::App& app) {
  auto options = std::make_shared<SessionVerbOptions>();
  app.add_option("session", options->session, "NAME.session")->required();
  app.add_option("-o,--output", options->outputs, "Table of the ticks: .csv, .wav or .nc; may be repeated");
  app.add_option("--strokes", options->strokes, "Table of all strokes: .csv, one line per stroke");
  cli::declare_force(app, options->existing);
  return [options] { return run_session(*options); };
}

}  // namespace

const cli::Verb kSessionVerb{
    "session", "Export a session; report the predicted and the measured displacement of each stroke",
    "tactograph session first -o first.csv -o first.nc", declare_session};

}  // namespace tacto::playback
