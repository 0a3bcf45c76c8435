// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "playback/cli/limits_report.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/daemon/session_export.hpp"
#include "playback/daemon/stroke_report.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Result;

namespace {

struct SessionVerbOptions {
  std::string session;
  std::vector<std::string> outputs;
};

Report stroke_row(const PlayedStroke& stroke) {
  Report row;
  row.add("from_s", stroke.from_s).add("to_s", stroke.to_s);
  row.add("from_m", stroke.from_m).add("to_m", stroke.to_m);
  row.add("received_rms_m", stroke.received_rms_m);
  if (stroke.wanted_rms_m > 0)
    row.add("wanted_rms_m", stroke.wanted_rms_m)
        .add("error_db", stroke.error_db)
        .add("received_over_wanted_db", stroke.level_db);
  if (stroke.limits && stroke.limits->removed_any())
    row.add("removed_by_limits_db", stroke.limits->removed_db());
  return row.add("limited_ticks", stroke.limited_ticks)
      .add("energy_limited_ticks", stroke.energy_limited_ticks)
      .add("gated_ticks", stroke.gated_ticks);
}

Result<Report> run_session(const SessionVerbOptions& o) {
  for (const std::string& output : o.outputs) {
    const auto said = export_session(o.session, output);
    if (!said) return schema::forward_error(said);
    if (!said->empty()) cli::warn(fmt::format("{}: {}", output, *said));
  }
  const auto strokes = report_strokes(o.session);
  if (!strokes) return schema::forward_error(strokes);
  for (const std::string& note : strokes->notes) cli::warn(note);
  Report report;
  report.add("session", schema::session_path(o.session));
  if (!o.outputs.empty()) report.add("written", o.outputs);
  report.add("band_low_hz", strokes->low_hz).add("band_high_hz", strokes->high_hz);
  add_removed(report, strokes->limits);
  if (strokes->limits) report.add("energy_limited_ticks", strokes->limits->energy_limited());
  std::vector<Report> rows;
  for (const PlayedStroke& stroke : strokes->strokes) rows.push_back(stroke_row(stroke));
  report.add("strokes", std::move(rows));
  if (strokes->damaged) report.ends_with(schema::Fault::malformed);
  return report;
}

cli::Action declare_session(CLI::App& app) {
  auto options = std::make_shared<SessionVerbOptions>();
  app.add_option("session", options->session, "NAME.session")->required();
  app.add_option("-o,--output", options->outputs,
                 "Table of the ticks: .csv, .wav or .nc; may be given again");
  return [options] { return run_session(*options); };
}

}  // namespace

const cli::Verb kSessionVerb{
    "session", "Export a session, and say of each stroke what the finger received against what was wanted",
    "tactograph session first -o first.csv -o first.nc", declare_session};

}  // namespace tacto::playback
