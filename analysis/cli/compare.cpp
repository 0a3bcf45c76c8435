// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>
#include <memory>

#include "analysis/cli/compare_report.hpp"
#include "analysis/cli/compared_input.hpp"
#include "analysis/cli/results_output.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/compare/compare_page.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/report/progress.hpp"
#include "playback/session/session_rows.hpp"
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
  schema::Existing existing = schema::Existing::keep;
};

constexpr const char* kRule =
    "The verdict, by this rule, in this order (T is --tolerance; louder and quieter describe B):\n  "
    "undecided        fewer than 8 segments of the window, or less than an octave in common\n  different     "
    "   by shape: the one-third-octave bands differ about their mean by more than the scatter of the "
    "segments causes once in 20 times (1,000 bootstrap draws), and by more than T beyond it (shape_db over "
    "shape_chance_db, shape_excess_db over T)\n  different        in a narrow band: among all bands of 1 to "
    "32 cells (a cell is 1 / window wide) the largest difference has a score above chance, and is larger "
    "than T; the band is named\n  different        by a line: one of the two has a line that the other does "
    "not have, with a score above chance, and more than T above the density in the window; its frequency is "
    "named\n  undecided        the segments scatter so much that a difference of T could not be detected "
    "(finest_shape_db over T)\n  louder, quieter  the mean level differs by more than T, and 0 dB is outside "
    "its 90 % interval\n  same             the whole interval is within T\n  undecided        in all other "
    "cases\nBands and lines are searched at all frequencies at once: together they call 5 % of the pairs of "
    "steady textures of one kind different. 'detectable' states which differences they find in at least 8 of "
    "10 pairs: read it together with 'same'. Textures whose level or spectrum changes along them (unsteady "
    "ones) are called different more often: 7 % of the pairs of noise whose level wanders by 3 dB over 10 "
    "mm, but more than half of the pairs of single strokes of 35 mm with bursts. Compare longer textures, or "
    "stretches in which the surface is even.\n'point by point' says whether the coherence is above the value "
    "that independent signals reach once in 20 times: two stretches of one rough surface can be the same "
    "without it.";

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

Result<Report> run_compare(const CompareVerbOptions& o, bool json) {
  TACTO_TRY(check_outputs(o.outputs, o.existing));
  cli::Progress progress("comparing");
  const std::function<void(double)> tell = [&](double part) { progress.update(part); };
  auto a = compared_input(o.a, o.stroke_a, playback::part_of(tell, 0, 0.4));
  TACTO_TRY(a);
  auto b = compared_input(o.b, o.stroke_b, playback::part_of(tell, 0.4, 0.8));
  TACTO_TRY(b);
  TACTO_TRY(match_session(*a, *b));
  const ComparedNames names{a->name, b->name};
  const auto comparison = compare(a->texture, b->texture, o.compare, playback::part_of(tell, 0.8, 1));
  TACTO_TRY(comparison);
  for (const std::string& note : comparison->notes) cli::warn(note);
  Report report = compare_report(names, *comparison);
  const auto written = write_outputs(o.outputs, o.existing, compare_results(o, names, *comparison), report,
                                     [&] { return comparison_page(*comparison, names); });
  TACTO_TRY(written);
  if (o.outputs.empty()) return report;
  if (!json) return brief_compare_report(names, *comparison, o.outputs);
  return report.add("written", o.outputs);
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
  app.add_option("A", options->a,
                 "Texture, recording (its stroke), or session (the displacement predicted from its drive)")
      ->required();
  app.add_option("B", options->b,
                 "A second one, of the same quantity; for a session also its own texture as the target")
      ->required();
  app.add_option("-o,--output,--page", options->outputs,
                 "Output: a page (.html) or results for 'report' (.results.json); may be repeated");
  cli::declare_force(app, options->existing);
  declare_pairing(app, *options);
  cli::add_quantity(app, "--tolerance", options->compare.tolerance_db, Dimension::level,
                    "Smallest level difference that counts; 2 dB are a quarter of the amplitude");
  cli::add_quantity(
      app, "--spectrum-window", options->compare.window_m, Dimension::length,
      "Window of the compared spectra [an eighth of the shorter, at most 8 waves of the lowest frequency]");
  spatial::declare_spectrogram(app, options->compare.spectrogram);
  app.footer(app.get_footer() + "\n" + kRule);
  return [options, &app] { return run_compare(*options, app.count("--json") > 0); };
}

}  // namespace

const cli::Verb kCompareVerb{"compare",
                             "Compare two textures, recordings, or a session and its texture: by band, "
                             "coherence and formants, with a verdict",
                             "tactograph compare oak pine -o oak-pine.html\n  tactograph compare "
                             "first.session oak --align correlation",
                             declare_compare};

}  // namespace tacto::analysis
