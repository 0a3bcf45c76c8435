// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/surfaces_report.hpp"

#include <fmt/format.h>

#include "analysis/compare/surfaces_page.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;

void add_side(Report& report, const std::string& side, const SideFacts& facts) {
  report.add(side, facts.name);
  if (!facts.simulated.empty()) report.add(side + "_simulated", facts.simulated);
  report.add(side + "_strokes", facts.strokes).add(side + "_recordings", facts.recordings);
  if (facts.speed_mps) report.add(side + "_speed_mps", *facts.speed_mps);
  if (facts.load_n) report.add(side + "_load_n", *facts.load_n);
}

std::vector<Report> sixth_rows(const SurfaceComparison& c) {
  std::vector<Report> rows;
  for (std::size_t i = 0; i + 1 < c.edges_per_m.size(); ++i) {
    Report& row = rows.emplace_back();
    row.add("low_per_m", c.edges_per_m[i]).add("high_per_m", c.edges_per_m[i + 1]);
    row.add("a_mean_db", c.a.level_db[i]).add("b_mean_db", c.b.level_db[i]);
    if (!c.test) continue;
    const BandWindow& window = c.test->windows[i];
    row.add("level_db", window.level_db).add("standard_error_db", window.error_db);
  }
  return rows;
}

void add_test(Report& report, const SurfaceComparison& c) {
  const LabelTest& test = *c.test;
  const BandWindow& window = test.windows[test.strongest];
  report.add("p", test.p).add("window_p", test.window_p).add("shape_p", test.shape_p);
  report.add("window_statistic", test.window_statistic).add("shape_statistic", test.shape_statistic);
  report.add("band_low_per_m", c.low_per_m(window)).add("band_high_per_m", c.high_per_m(window));
  report.add("band_level_db", window.level_db);
  report.add("band_level_low_db", window.level_db - test.reach * window.error_db);
  report.add("band_level_high_db", window.level_db + test.reach * window.error_db);
  report.add("spread_db", test.spread_db).add("finest_third_octave_db", c.finest_third_octave_db);
  report.add("finest_level_db", c.finest_level_db);
}

}  // namespace

Report surfaces_report(const SurfaceComparison& c) {
  Report report;
  add_side(report, "a", c.a);
  add_side(report, "b", c.b);
  report.add("verdict", to_string(c.verdict)).add("because", c.because);
  report.add("tolerance_db", c.tolerance_db);
  report.add("unit", c.by_recording ? "recording" : "stroke");
  report.add("holds_for_these_recordings_only", !c.by_recording);
  report.add("separable", c.separable);
  if (c.test) add_test(report, c);
  return report.add("bands", sixth_rows(c));
}

Report brief_surfaces_report(const SurfaceComparison& c) {
  Report report;
  for (const schema::ResultFigure& figure : surfaces_figures(c)) report.add(figure.name, figure.value);
  return report;
}

}  // namespace tacto::analysis
