// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/compare_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::for_people;

Report band_row(const BandComparison& band) {
  Report row;
  row.add("centre_per_m", band.centre_per_m).add("partial", band.partial);
  row.add("level_db", band.level_db).add("scatter_db", band.scatter_db);
  if (band.error_db) row.add("error_db", *band.error_db);
  if (band.residual_db) row.add("residual_db", *band.residual_db);
  if (band.coherence) row.add("coherence", *band.coherence);
  return row;
}

Report formant_row(const char* what, const schema::Formant* a, const schema::Formant* b) {
  Report row;
  row.add("formant", what);
  if (a != nullptr) row.add("a_frequency_per_m", a->frequency_per_m);
  if (b != nullptr) row.add("b_frequency_per_m", b->frequency_per_m);
  if (a != nullptr && b != nullptr) row.add("level_db", b->level_db - a->level_db);
  return row;
}

std::vector<Report> formant_rows(const Comparison& c) {
  std::vector<Report> rows;
  for (const auto& [i, j] : c.formants.matched)
    rows.push_back(formant_row("matched", &c.a_formants[i], &c.b_formants[j]));
  for (const std::size_t i : c.formants.missed)
    rows.push_back(formant_row("missed", &c.a_formants[i], nullptr));
  for (const std::size_t j : c.formants.extra)
    rows.push_back(formant_row("extra", nullptr, &c.b_formants[j]));
  return rows;
}

void add_pair(Report& report, const Comparison& c) {
  report.add("aligned_by", c.pair.aligned).add("length_m", c.pair.length_m());
  report.add("a_from_m", c.pair.a_from_m).add("b_from_m", c.pair.b_from_m);
  if (c.pair.correlation) report.add("shift_m", c.pair.shift_m).add("correlation", *c.pair.correlation);
  report.add("pitch_m", c.pair.pitch_m).add("window_m", c.window_m);
  report.add("low_per_m", c.low_per_m).add("high_per_m", c.high_per_m);
}

void add_evidence(Report& report, const Comparison& c) {
  const Evidence& e = c.evidence;
  report.add("segments", e.segments).add("level_db", e.level_db);
  report.add("level_low_db", e.level_low_db).add("level_high_db", e.level_high_db);
  report.add("shape_db", e.shape_db).add("shape_chance_db", e.shape_chance_db);
  report.add("shape_excess_db", e.shape_excess_db).add("finest_shape_db", e.finest_shape_db);
  report.add("power_level_db", c.power_level_db).add("spectral_distance_db", c.spectral_distance_db);
}

void add_places(Report& report, const Comparison& c) {
  if (!c.pair.paired) return;
  report.add("gain", *c.gain).add("error_db", *c.error_db).add("residual_db", *c.residual_db);
  report.add("coherence", *c.coherence).add("chance_coherence", c.chance_coherence);
  report.add("point_by_point", c.point_by_point);
}

void add_narrow(Report& report, const Comparison& c) {
  if (const auto& band = c.evidence.narrow) {
    report.add("band_low_per_m", band->low_per_m).add("band_high_per_m", band->high_per_m);
    report.add("band_level_db", band->level_db).add("band_score", band->score);
    report.add("band_chance_score", band->chance_score);
    report.add("band_differs", band_differs(c.evidence, c.tolerance_db));
  }
  if (const auto& line = c.evidence.line) {
    report.add("line_per_m", line->frequency_per_m).add("line_in", line->in_b ? "B" : "A");
    report.add("line_level_db", line->level_db).add("line_score", line->score);
    report.add("line_chance_score", line->chance_score);
    report.add("line_differs", line_differs(c.evidence, c.tolerance_db));
  }
}

void add_detectable(Report& report, const Comparison& c) {
  const std::string words = detectable_words(c.evidence, c.tolerance_db);
  if (words.empty()) return;
  report.add("detectable", words);
  std::vector<Report> rows;
  if (c.evidence.narrow)
    for (const DetectableBand& band : c.evidence.narrow->detectable)
      rows.push_back(Report().add("width_per_m", band.width_per_m).add("level_db", band.level_db));
  report.add("detectable_bands", std::move(rows));
  if (c.evidence.line)
    report.add("detectable_line_db", std::max(c.evidence.line->detectable_db, c.tolerance_db));
}

std::string compared_band(const Comparison& c) {
  return fmt::format("{} to {}", for_people(c.low_per_m, Dimension::spatial_frequency),
                     for_people(c.high_per_m, Dimension::spatial_frequency));
}

void add_rms(Report& report, const Comparison& c) {
  report.add("rms_band", compared_band(c) + ": of both RMS values, the band that is compared");
  report.add(schema::key_in("a_rms", c.pair.unit), c.a_rms)
      .add(schema::key_in("b_rms", c.pair.unit), c.b_rms);
}

}  // namespace

Report compare_report(const ComparedNames& names, const Comparison& c) {
  Report report;
  report.add("a", names.a).add("b", names.b);
  if (!c.simulated.a.empty()) report.add("a_simulated", c.simulated.a);
  if (!c.simulated.b.empty()) report.add("b_simulated", c.simulated.b);
  if (!names.with_target) {
    report.add("beyond_measurement_noise", to_string(c.verdict.likeness)).add("because", c.verdict.because);
    report.add("tolerance_db", c.tolerance_db);
    add_detectable(report, c);
  }
  add_pair(report, c);
  add_rms(report, c);
  if (!names.with_target) add_evidence(report, c);
  add_places(report, c);
  if (!names.with_target) add_narrow(report, c);
  std::vector<Report> bands;
  for (const BandComparison& band : c.bands) bands.push_back(band_row(band));
  report.add("bands", std::move(bands));
  if (names.with_target) return report;
  report.add("matched", c.formants.matched.size()).add("missed", c.formants.missed.size());
  return report.add("extra", c.formants.extra.size()).add("formants", formant_rows(c));
}

}  // namespace tacto::analysis
