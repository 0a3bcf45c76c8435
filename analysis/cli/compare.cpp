// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/cli/compared_input.hpp"
#include "analysis/cli/results_output.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/compare/compare.hpp"
#include "analysis/compare/compare_page.hpp"
#include "analysis/compare/label_test.hpp"
#include "analysis/compare/surfaces.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/report.hpp"
#include "playback/session/session_rows.hpp"
#include "spatial/cli/spectrogram_options.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Dimension;
using schema::for_people;
using schema::Result;

struct CompareVerbOptions {
  std::string a, b;
  std::vector<std::string> more;
  std::vector<std::string> many_a, many_b;
  std::size_t stroke_a = 0, stroke_b = 0;
  CompareOptions compare;
  std::vector<std::string> outputs;
  schema::Existing existing = schema::Existing::keep;
};

constexpr const char* kRule =
    "Surfaces: A and B with several strokes (recordings, or lists by --a and --b). The verdict answers "
    "whether "
    "the strokes of A and B differ more than strokes of one side differ from each other:\n  different        "
    "    "
    "p is at most 0.05 ({} exchanges of A and B), and the band that differs most differs by --tolerance or "
    "more; where the interval of that band contains 0 dB, the shapes of the spectra differ, all bands "
    "together\n  no difference found  otherwise; 'detectable' states what would have been found\n  undecided "
    "    "
    "     "
    "  fewer than 5 strokes a side in the same directions (12 a side are better), or different speed or load "
    "explains more than three quarters of the difference between the sides\nWith 4 recordings a side or "
    "more, the "
    "recording is the unit. With fewer, the verdict holds for these recordings only.\nRecord both sides with "
    "the "
    "same finger at the same speed and load, alternately: A, B, A, B. A drift within a session is not "
    "detected: "
    "levels that drift by 1 dB from A to B cause 19 to 48 % false alarms.\n\n"
    "Single textures: A and B with one texture each (also by --stroke-a, --stroke-b). The verdict answers "
    "whether they differ beyond measurement noise. It does not answer whether the surfaces differ: strokes "
    "over "
    "one surface differ, too, by 1.4 to 4 dB in a sixth of an octave. By this rule, in this order (T is "
    "--tolerance; louder and quieter describe B):\n  "
    "undecided        fewer than 8 segments of the window, or less than an octave in common\n  different     "
    "   by shape: the one-third-octave bands differ about their mean by more than the scatter of the "
    "segments causes once in 20 times (1,000 bootstrap draws), and by more than T beyond it (shape_db over "
    "shape_chance_db, shape_excess_db over T)\n  different        in a narrow band: among all bands of 1 to "
    "32 cells (a cell is 1 / window wide) the largest difference has a score above chance, and is larger "
    "than T; the band is named\n  different        by a line: one of the two has a line that the other does "
    "not have, with a score above chance, and more than T above the density in the window; its frequency is "
    "named\n  undecided        the segments scatter so much that a difference of T could not be detected "
    "(finest_shape_db over T)\n  louder, quieter  the mean level differs by more than T, and 0 dB is outside "
    "its 90 % interval\n  none             the whole interval is within T\n  undecided        in all other "
    "cases\nBands and lines are searched at all frequencies at once: together they call 5 % of the pairs of "
    "steady textures of one kind different. 'detectable' states which differences they find in at least 8 of "
    "10 pairs: read it together with 'none'. Textures whose level or spectrum changes along them (unsteady "
    "ones) are called different more often: 7 % of the pairs of noise whose level wanders by 3 dB over 10 "
    "mm, but more than half of the pairs of single strokes of 35 mm with bursts.\n'point by point' says "
    "whether "
    "the coherence is above the value that independent signals reach once in 20 times: two sections of one "
    "rough surface can be alike without it.\n\n"
    "A session and its texture: the error in dB, the power of the difference over that of the target.\n\n"
    "More than two inputs: each pair by itself, so that one pair in 20 is called different by chance.";

schema::Results compare_results(const CompareVerbOptions& o, const ComparedNames& names,
                                const Comparison& c) {
  schema::Results results;
  results.verb = "compare";
  results.inputs = {o.a, o.b};
  results.simulated = c.simulated.words();
  results.figures = comparison_figures(c, names);
  results.pictures = comparison_pictures(c, names);
  return results;
}

using Tell = std::function<void(double)>;

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

// The whole report, the verdict first.
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

Result<Report> compare_pair(const CompareVerbOptions& o, ComparedInput& a, ComparedInput& b,
                            const Tell& tell) {
  const bool with_target = a.played.has_value() != b.played.has_value();
  if (with_target && o.compare.pair.align == PairAlign::none)
    return schema::fail(schema::ErrorKind::usage,
                        "the error of a session is that of each place, so that 'none' can't be used",
                        "--align", "use position or correlation");
  TACTO_TRY(match_session(a, b));
  const ComparedNames names{a.name, b.name, with_target};
  const auto comparison = compare(a.texture, b.texture, o.compare, tell);
  TACTO_TRY(comparison);
  for (const std::string& note : comparison->notes) cli::warn(note);
  Report report = compare_report(names, *comparison);
  const auto written = write_outputs(o.outputs, o.existing, compare_results(o, names, *comparison), report,
                                     [&] { return comparison_page(*comparison, names); });
  TACTO_TRY(written);
  return o.outputs.empty() ? report : report.add("written", o.outputs);
}

Result<Report> compare_named_pair(const CompareVerbOptions& o, const Tell& tell) {
  auto a = compared_input(o.a, o.stroke_a, playback::part_of(tell, 0, 0.4));
  TACTO_TRY(a);
  auto b = compared_input(o.b, o.stroke_b, playback::part_of(tell, 0.4, 0.8));
  TACTO_TRY(b);
  return compare_pair(o, *a, *b, playback::part_of(tell, 0.8, 1));
}

SurfaceSide surface_side(const std::vector<std::string>& names, std::vector<spatial::NamedTexture> textures) {
  constexpr std::size_t kNamed = 6;  // as many fit into a legend
  const std::size_t named = names.size() > kNamed ? kNamed - 1 : names.size();
  SurfaceSide side;
  side.name = fmt::format("{}", fmt::join(std::span(names).first(named), ", "));
  if (named < names.size()) side.name += fmt::format(" and {} more", names.size() - named);
  for (spatial::NamedTexture& texture : textures) {
    side.stroke_names.push_back(texture.name);
    side.strokes.push_back(std::move(texture.texture));
  }
  return side;
}

Result<void> check_sides(const std::vector<spatial::NamedTexture>& a,
                         const std::vector<spatial::NamedTexture>& b) {
  for (const auto& left : a)
    for (const auto& right : b)
      if (left.stored && right.stored && schema::same_file(left.path, right.path))
        return schema::fail(schema::ErrorKind::usage, "is on both sides", left.path,
                            "name each texture on one side");
  return {};
}

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

// The complete report: for --json and for results.
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

// The main figures, for the terminal.
Report brief_surfaces_report(const SurfaceComparison& c) {
  Report report;
  for (const schema::ResultFigure& figure : surfaces_figures(c)) report.add(figure.name, figure.value);
  return report;
}

Result<Report> compare_strokes(const CompareVerbOptions& o, bool json, const SurfaceSide& a,
                               const SurfaceSide& b, schema::Results results) {
  const auto comparison = compare_surfaces(a, b, o.compare.tolerance_db);
  TACTO_TRY(comparison);
  for (const std::string& note : comparison->notes) cli::warn(note);
  results.verb = "compare";
  results.simulated = comparison->simulated().words();
  results.figures = surfaces_figures(*comparison);
  results.pictures = surfaces_pictures(*comparison);
  Report report = json ? surfaces_report(*comparison) : brief_surfaces_report(*comparison);
  TACTO_TRY(write_outputs(o.outputs, o.existing, std::move(results), surfaces_report(*comparison),
                          [&] { return surfaces_page(*comparison); }));
  if (!o.outputs.empty()) report.add("written", o.outputs);
  return report;
}

// A and B by --a and --b, or by position if they have several textures.
Result<Report> compare_sides(const CompareVerbOptions& o, bool json, const Tell& tell) {
  const bool lists = !o.many_a.empty();
  const std::vector<std::string> names_a = lists ? o.many_a : std::vector{o.a};
  const std::vector<std::string> names_b = lists ? o.many_b : std::vector{o.b};
  auto a = spatial::open_textures(names_a);
  TACTO_TRY(a);
  tell(0.4);
  auto b = spatial::open_textures(names_b);
  TACTO_TRY(b);
  tell(0.8);
  if (!lists && a->size() == 1 && b->size() == 1) {
    ComparedInput one = compared_input(std::move(a->front())), other = compared_input(std::move(b->front()));
    return compare_pair(o, one, other, playback::part_of(tell, 0.8, 1));
  }
  TACTO_TRY(check_sides(*a, *b));
  schema::Results results;
  results.inputs = names_a;
  results.inputs.insert(results.inputs.end(), names_b.begin(), names_b.end());
  return compare_strokes(o, json, surface_side(names_a, std::move(*a)), surface_side(names_b, std::move(*b)),
                         std::move(results));
}

using Inputs = std::vector<std::vector<spatial::NamedTexture>>;

struct PairAnswer {
  std::string word;  // the verdict of surfaces
  double db = 0;     // spectral distance of single textures
};

Result<PairAnswer> answer_textures(const CompareVerbOptions& o, const spatial::NamedTexture& a,
                                   const spatial::NamedTexture& b, Report& row) {
  const auto found = compare(a.texture, b.texture, o.compare);
  TACTO_TRY(found);
  PairAnswer answer;
  answer.db = found->spectral_distance_db;
  row.add("beyond_measurement_noise", to_string(found->verdict.likeness))
      .add("because", found->verdict.because);
  row.add("spectral_distance_db", answer.db).add("level_db", found->evidence.level_db);
  return answer;
}

Result<PairAnswer> answer_surfaces(const CompareVerbOptions& o, const SurfaceSide& a, const SurfaceSide& b,
                                   Report& row) {
  const auto found = compare_surfaces(a, b, o.compare.tolerance_db);
  TACTO_TRY(found);
  PairAnswer answer;
  answer.word = to_string(found->verdict);
  row.add("verdict", answer.word).add("because", found->because);
  if (found->test) row.add("p", found->test->p);
  return answer;
}

// Each pair is compared by itself.
Result<Report> compare_all(const CompareVerbOptions& o, const Tell& tell) {
  std::vector<std::string> names{o.a, o.b};
  names.insert(names.end(), o.more.begin(), o.more.end());
  Inputs inputs;
  for (const std::string& name : names) {
    auto textures = spatial::open_textures({name});
    TACTO_TRY(textures);
    inputs.push_back(std::move(*textures));
  }
  const bool single = std::ranges::all_of(inputs, [](const auto& textures) { return textures.size() == 1; });
  std::vector<Report> matrix, pairs;
  for (const std::string& name : names)  // the columns have these numbers
    matrix.push_back(Report().add("number", matrix.size() + 1).add("input", name));
  const std::size_t count = names.size() * (names.size() - 1) / 2;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      TACTO_TRY(check_sides(inputs[i], inputs[j]));
      Report& pair = pairs.emplace_back().add("a", names[i]).add("b", names[j]);
      const auto answer = single ? answer_textures(o, inputs[i].front(), inputs[j].front(), pair)
                                 : answer_surfaces(o, surface_side({names[i]}, inputs[i]),
                                                   surface_side({names[j]}, inputs[j]), pair);
      TACTO_TRY(answer);
      const std::string column = std::to_string(j + 1);
      if (single)
        matrix[i].add(column + "_db", answer->db);
      else
        matrix[i].add(column, answer->word);
      tell(static_cast<double>(pairs.size()) / static_cast<double>(count));
    }
  Report report;
  report.add("compared",
             single ? "single textures: spectral distance" : "surfaces: verdict by their strokes");
  report.add("inputs", names.size()).add("tolerance_db", o.compare.tolerance_db);
  return report.add("matrix", std::move(matrix)).add("pairs", std::move(pairs));
}

Result<Report> run_compare(const CompareVerbOptions& o, bool json) {
  if (o.a.empty() != o.b.empty() || o.a.empty() == o.many_a.empty())
    return schema::fail(schema::ErrorKind::usage, "two sides are needed", "compare",
                        "name A and B, or both --a and --b");
  TACTO_TRY(check_outputs(o.outputs, o.existing));
  cli::Progress progress("comparing");
  const Tell tell = [&](double part) { progress.update(part); };
  if (!o.more.empty()) {
    if (!o.outputs.empty() || o.stroke_a > 0 || o.stroke_b > 0)
      return schema::fail(schema::ErrorKind::usage,
                          "more than two inputs have a table only, of all their strokes",
                          o.outputs.empty() ? "--stroke-a and --stroke-b" : "--output", "name two inputs");
    return compare_all(o, tell);
  }
  const bool pair = o.stroke_a > 0 || o.stroke_b > 0 || names_a_session(o.a) || names_a_session(o.b);
  return pair ? compare_named_pair(o, tell) : compare_sides(o, json, tell);
}

void declare_pairing(CLI::App& app, CompareVerbOptions& o) {
  cli::add_choice<PairAlign>(
      app, "--align", o.compare.pair.align,
      {{"position", PairAlign::position}, {"correlation", PairAlign::correlation}, {"none", PairAlign::none}},
      "How A and B are aligned: by their places on the bench (by their starts, if they share little there), "
      "by correlation from there, or not at all");
  cli::add_quantity(app, "--max-shift", o.compare.pair.max_shift_m, Dimension::length,
                    "Largest shift that --align correlation tests");
  app.add_option("--stroke-a", o.stroke_a, "Stroke of A, if A has several")->check(cli::from_one());
  app.add_option("--stroke-b", o.stroke_b, "Stroke of B, if B has several")->check(cli::from_one());
}

cli::Action declare_compare(CLI::App& app) {
  auto options = std::make_shared<CompareVerbOptions>();
  CLI::Option* a = app.add_option(
      "A", options->a,
      "Recording (each stroke is used), texture, or session (the displacement predicted from its drive)");
  CLI::Option* b =
      app.add_option("B", options->b, "A second one, of the same quantity; for a session its own texture");
  app.add_option("MORE", options->more, "Further recordings or textures: a table of all pairs");
  CLI::Option* many_a =
      app.add_option("--a", options->many_a, "Instead of A: several recordings or textures");
  CLI::Option* many_b =
      app.add_option("--b", options->many_b, "Instead of B: several recordings or textures");
  many_a->needs(many_b)->excludes(a)->excludes(b);
  many_b->needs(many_a);
  app.add_option("-o,--output,--page", options->outputs,
                 "Output: a page (.html) or results for 'report' (.results.json); may be repeated");
  cli::declare_force(app, options->existing);
  declare_pairing(app, *options);
  cli::add_quantity(app, "--tolerance", options->compare.tolerance_db, Dimension::level,
                    "Smallest level difference that counts; 2 dB change the amplitude by 26 %");
  cli::add_quantity(
      app, "--spectrum-window", options->compare.window_m, Dimension::length,
      "Window of the compared spectra [an eighth of the shorter, at most 8 waves of the lowest frequency]");
  spatial::declare_spectrogram(app, options->compare.spectrogram);
  app.footer(app.get_footer() + "\n" + fmt::format(kRule, kExchanges));
  return [options, &app] { return run_compare(*options, app.count("--json") > 0); };
}

}  // namespace

const cli::Verb kCompareVerb{
    "compare",
    "Compare two surfaces by several strokes, two single textures, or a session and "
    "its texture",
    "tactograph compare oak pine -o oak-pine.html\n  tactograph compare --a oak-1 oak-2 "
    "--b pine-1 pine-2\n  tactograph compare oak pine birch\n  tactograph compare oak pine --stroke-a 1 "
    "--stroke-b 1\n  "
    "tactograph compare first.session oak --align correlation",
    declare_compare};

}  // namespace tacto::analysis
