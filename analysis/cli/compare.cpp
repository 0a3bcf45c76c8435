// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>
#include <memory>

#include "analysis/cli/compared_input.hpp"
#include "analysis/cli/results_output.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/compare/compare_page.hpp"
#include "data-schema/cli/progress.hpp"
#include "playback/daemon/session_rows.hpp"
#include "spatial/cli/spectrogram_options.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::Result;

struct CompareVerbOptions {
  std::string a, b;
  std::size_t stroke_a = 0, stroke_b = 0;
  CompareOptions compare;
  std::vector<std::string> outputs;
};

constexpr const char* kRule =
    "The verdict, by this rule, in this order (T is --tolerance; all from 1,000 bootstrap draws of the "
    "segments, so that "
    "the textures' own parts say what chance does; louder and quieter are said of B):\n"
    "  undecided        fewer than 8 segments, or less than an octave in common\n"
    "  different        the bands differ about their mean by more than the scatter of the parts makes once "
    "in 20 times, "
    "and by more than T beyond it (shape_db over shape_chance_db, and shape_excess_db over T)\n"
    "  undecided        the parts scatter so much that T would not show (finest_shape_db over T)\n"
    "  louder, quieter  the mean level is off by more than T, and its 90 % interval does not hold 0 dB\n"
    "  same             the whole interval lies within T\n"
    "  undecided        else\n"
    "'point by point' says whether the coherence is above what signals with nothing in common reach once in "
    "20 times: "
    "two stretches of one rough surface can be the same without it.";

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
  if (!c.pair.paired) return;
  report.add("gain", *c.gain).add("error_db", *c.error_db).add("residual_db", *c.residual_db);
  report.add("coherence", *c.coherence).add("chance_coherence", c.chance_coherence);
  report.add("point_by_point", c.point_by_point);
}

Report compare_report(const ComparedNames& names, const Comparison& c) {
  Report report;
  report.add("a", names.a).add("b", names.b);
  if (!c.a_simulated.empty()) report.add("a_simulated", c.a_simulated);
  if (!c.b_simulated.empty()) report.add("b_simulated", c.b_simulated);
  report.add("verdict", word_of(c.verdict.likeness)).add("because", c.verdict.because);
  report.add("tolerance_db", c.tolerance_db);
  add_pair(report, c);
  add_evidence(report, c);
  std::vector<Report> bands;
  for (const BandComparison& band : c.bands) bands.push_back(band_row(band));
  report.add("bands", std::move(bands));
  report.add("matched", c.formants.matched.size()).add("missed", c.formants.missed.size());
  return report.add("extra", c.formants.extra.size()).add("formants", formant_rows(c));
}

schema::Results compare_results(const CompareVerbOptions& o, const ComparedNames& names,
                                const Comparison& c) {
  schema::Results results;
  results.verb = "compare";
  results.inputs = {o.a, o.b};
  results.simulated = c.a_simulated.empty() ? c.b_simulated : c.a_simulated;
  results.figures = comparison_figures(c);
  results.pictures = comparison_pictures(c, names);
  return results;
}

Result<Report> run_compare(const CompareVerbOptions& o) {
  if (const auto free = check_outputs(o.outputs); !free) return schema::forward_error(free);
  cli::Progress progress("comparing");
  const std::function<void(double)> tell = [&](double part) { progress.update(part); };
  auto a = compared_input(o.a, o.stroke_a, playback::part_of(tell, 0, 0.4));
  if (!a) return schema::forward_error(a);
  auto b = compared_input(o.b, o.stroke_b, playback::part_of(tell, 0.4, 0.8));
  if (!b) return schema::forward_error(b);
  if (const auto matched = match_session(*a, *b); !matched) return schema::forward_error(matched);
  const ComparedNames names{a->name, b->name};
  const auto comparison = compare(a->texture, b->texture, o.compare, playback::part_of(tell, 0.8, 1));
  if (!comparison) return schema::forward_error(comparison);
  for (const std::string& note : comparison->notes) cli::warn(note);
  Report report = compare_report(names, *comparison);
  const auto written = write_outputs(o.outputs, compare_results(o, names, *comparison), report,
                                     [&] { return comparison_page(*comparison, names); });
  if (!written) return schema::forward_error(written);
  if (!o.outputs.empty()) report.add("written", o.outputs);
  return report;
}

void declare_pairing(CLI::App& app, CompareVerbOptions& o) {
  cli::add_choice<PairAlign>(
      app, "--align", o.compare.pair.align,
      {{"position", PairAlign::position}, {"correlation", PairAlign::correlation}, {"none", PairAlign::none}},
      "How places of A are found in B: by where both lay on the bench (from both starts, where they "
      "have little in common there), by correlation from there, or not at all");
  cli::add_quantity(app, "--max-shift", o.compare.pair.max_shift_m, Dimension::length,
                    "Farthest shift that --align correlation tries");
  app.add_option("--stroke-a", o.stroke_a, "Which of A's strokes, where it has several")
      ->check(cli::from_one());
  app.add_option("--stroke-b", o.stroke_b, "Which of B's")->check(cli::from_one());
}

cli::Action declare_compare(CLI::App& app) {
  auto options = std::make_shared<CompareVerbOptions>();
  app.add_option("A", options->a,
                 "Texture, recording (its stroke becomes one), or session (what its finger received)")
      ->required();
  app.add_option("B", options->b, "Another, of the same quantity; a session's own texture as it was wanted")
      ->required();
  app.add_option("-o,--output,--page", options->outputs,
                 "What to write: a page (.html), results for 'report' (.results.json); may be given again");
  declare_pairing(app, *options);
  cli::add_quantity(app, "--tolerance", options->compare.tolerance_db, Dimension::level,
                    "What counts as a difference; 2 dB are a quarter of the amplitude");
  cli::add_quantity(
      app, "--spectrum-window", options->compare.window_m, Dimension::length,
      "Of the spectra that are compared [an eighth of the shorter, at most 8 waves of the lowest frequency]");
  spatial::declare_spectrogram(app, options->compare.spectrogram);
  app.footer(app.get_footer() + "\n" + kRule);
  return [options] { return run_compare(*options); };
}

}  // namespace

const cli::Verb kCompareVerb{"compare",
                             "Hold two textures, recordings or a session and its texture against each other: "
                             "by band, by coherence, by formants, and "
                             "in a word",
                             "tactograph compare oak pine -o oak-pine.html\n  tactograph compare "
                             "first.session oak --align correlation",
                             declare_compare};

}  // namespace tacto::analysis
