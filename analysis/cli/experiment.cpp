// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "analysis/cli/experiment_study.hpp"
#include "analysis/cli/results_output.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/experiment/adjustment_answers.hpp"
#include "analysis/experiment/amplitude_answers.hpp"
#include "analysis/experiment/answers_page.hpp"
#include "analysis/experiment/fidelity_answers.hpp"
#include "analysis/experiment/identification_answers.hpp"
#include "analysis/experiment/ordering_answers.hpp"
#include "analysis/experiment/study_answers.hpp"
#include "analysis/experiment/withdrawal.hpp"
#include "analysis/page/picture_svg.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

struct FitOptions {
  std::string verb = "experiment fit";
  std::string file;
  AnswerColumns columns;
  PsychometricOptions fit;
  bool pairs = false;
  std::vector<std::string> outputs;
  schema::Existing existing = schema::Existing::keep;
};

constexpr const char* kFitHelp =
    "Columns: those that no option names are, in this order, the level, the number of answers 'yes' "
    "(correct, "
    "faster) and, where there is a third, the number of other answers, or of trials if its name is trials, "
    "n, "
    "total or count. Without a third, each row is one trial with the answer 0 or 1. Rows with equal levels "
    "are "
    "added.\n--by: the first column is the person, the others are conditions. Each group of rows has its own "
    "function; two conditions are compared by a paired t test of the logarithms of the JNDs.\nWithout "
    "--guess "
    "two stimuli are compared: PSE is the level that seems equal to the standard (50 %), JND the distance "
    "from "
    "there to the level at which the function without lapses is 75 %. With --guess, threshold is the level "
    "half-way between guessing and the upper end, width the distance between the levels at 5 and 95 % of the "
    "way. Estimates are the most probable values; with --lapse 0% they are those of probit regression.\n"
    "--pairs: columns winner, loser and count; a scale by Bradley and Terry.";

void add_estimate(Report& row, const std::string& key, const Estimate& estimate) {
  row.add(key, estimate.value).add(key + "_low", estimate.low).add(key + "_high", estimate.high);
}

void add_by(Report& row, const std::vector<std::string>& columns, const std::vector<std::string>& by) {
  for (std::size_t i = 0; i < columns.size(); ++i) row.add(columns[i], by[i]);
}

void add_test(Report& row, double deviance, std::size_t freedom, double p) {
  row.add("deviance", deviance).add("degrees_of_freedom", freedom).add("p", p);
}

Report fit_row(const AnswersFit& all, const FittedGroup& group) {
  Report row;
  add_by(row, all.table.columns.by, group.by);
  if (all.options.threshold)
    row.add("pse", *all.options.threshold).add("pse_is_fixed", true);
  else
    add_estimate(row, all.options.guess ? "threshold" : "pse", group.fit.threshold);
  add_estimate(row, all.steepness_name == "JND" ? "jnd" : all.steepness_name, group.steepness);
  row.add("lapse", group.fit.function.lapse);
  if (!all.options.lapse) row.add("lapse_high", group.fit.lapse_high);
  if (all.options.overdispersed)
    row.add("overdispersion", group.fit.overdispersion)
        .add("overdispersion_high", group.fit.overdispersion_high);
  add_test(row, group.fit.deviance, group.fit.freedom, group.fit.p);
  return row;
}

Report people_row(const AnswersFit& all, const OverPeople& over) {
  std::vector<Report> rows;
  for (const ConditionOverPeople& each : over.conditions) {
    Report& row = rows.emplace_back();
    add_by(row, {all.table.columns.by.begin() + 1, all.table.columns.by.end()}, each.condition);
    row.add("people", each.people.size()).add("mean", each.mean);
    add_estimate(row, "geometric_mean", each.geometric);
  }
  Report report;
  report.add("conditions", std::move(rows));
  if (over.test)
    report.add("t", over.test->t).add("degrees_of_freedom", over.test->freedom).add("p", over.test->p);
  return report;
}

// All values, for --json and results.
Report answers_report(const AnswersFit& all, const std::string& verdict) {
  Report report;
  report.add("verdict", verdict).add("level", all.table.columns.level).add("unit", all.table.unit);
  report.add("yes", all.table.columns.yes);
  if (!all.table.simulated.empty()) report.add("simulated", all.table.simulated);
  std::vector<Report> rows;
  for (const FittedGroup& group : all.groups) rows.push_back(fit_row(all, group));
  report.add("fits", std::move(rows));
  if (!all.not_fitted.empty()) report.add("not_fitted", all.not_fitted);
  if (all.over_people) report.add("over_people", std::vector<Report>{people_row(all, *all.over_people)});
  if (all.without_lapses)
    report.add("without_lapses", std::vector<Report>{people_row(all, *all.without_lapses)});
  return report;
}

Report preferences_report(const FitOptions& o, const std::vector<ScaledGroup>& scales,
                          const std::string& verdict) {
  Report report;
  report.add("verdict", verdict);
  std::vector<Report> groups;
  for (const ScaledGroup& each : scales) {
    Report& group = groups.emplace_back();
    add_by(group, o.columns.by, each.by);
    std::vector<Report> items;
    for (const ScaledItem& item : each.scale.items) {
      items.emplace_back().add("item", item.name);
      add_estimate(items.back(), "ability", item.ability);
    }
    group.add("items", std::move(items)).add("comparisons", each.scale.comparisons);
    add_test(group, each.scale.deviance, each.scale.freedom, each.scale.p);
  }
  return report.add("scales", std::move(groups));
}

// For the terminal: the figures, then a row per group if there are several.
Report brief_report(const Findings& findings) {
  Report report;
  for (const schema::ResultFigure& figure : findings.figures) report.add(figure.name, figure.value);
  if (!findings.simulated.empty()) report.add("simulated", findings.simulated);
  if (findings.groups.size() < 3) return report;
  std::vector<Report> rows(findings.groups.size() - 1);
  for (std::size_t row = 0; row < rows.size(); ++row)
    add_by(rows[row], findings.groups.front(), findings.groups[row + 1]);
  return report.add(findings.pictures.empty() ? "people" : "fits", std::move(rows));
}

Result<std::string> picture_svg(const Findings& findings) {
  if (findings.pictures.size() == 1)
    return spatial::to_svg(figure_of(findings.pictures.front(), findings.simulated));
  if (findings.pictures.empty())
    return schema::fail(ErrorKind::usage, "there is no picture", "--output",
                        "name a page (.html) or results (.results.json)");
  return schema::fail(ErrorKind::usage, fmt::format("there are {} pictures", findings.pictures.size()),
                      "--output", "name a page (.html), which shows all");
}

OutputKind svg_output(const Findings& findings) {
  return {".svg", [](std::string_view) { return true; }, [&] { return picture_svg(findings); }};
}

// Writes the outputs; `details` is for --json and results.
Result<Report> write_fit(const FitOptions& o, const Findings& findings, Report details, bool json) {
  schema::Results results;
  results.verb = o.verb;
  results.inputs = {o.file};
  results.figures = findings.figures;
  results.pictures = findings.pictures;
  results.simulated = findings.simulated;
  const OutputKind svg = svg_output(findings);
  TACTO_TRY(write_outputs(o.outputs, o.existing, std::move(results), details,
                          [&] { return findings_page(o.file, findings); }, {&svg, 1}));
  Report printed = json ? std::move(details) : brief_report(findings);
  return o.outputs.empty() ? printed : printed.add("written", o.outputs);
}

Result<Report> fit_table(const FitOptions& o, AnswersTable table, bool json) {
  cli::Progress progress("fitting");
  auto fit = fit_answers(std::move(table), o.fit, [&](double part) { progress.update(part); });
  if (!fit) fit.error().where = o.file + (fit.error().where.empty() ? "" : ": " + fit.error().where);
  TACTO_TRY(fit);
  const Findings findings = findings_of(*fit);
  return write_fit(o, findings, answers_report(*fit, findings.verdict()), json);
}

Result<Report> fit_levels(const FitOptions& o, bool json) {
  auto table = read_answers(o.file, o.columns);
  TACTO_TRY(table);
  return fit_table(o, std::move(*table), json);
}

Result<Report> fit_pairs(const FitOptions& o, bool json) {
  const auto groups = read_preferences(o.file, o.columns.by);
  TACTO_TRY(groups);
  std::vector<ScaledGroup> scales;
  for (const auto& group : *groups) {
    auto scale = fit_preferences(group.rows);
    if (!scale) scale.error().where = group.by.empty() ? o.file : o.file + ": " + group_name(group.by);
    TACTO_TRY(scale);
    scales.push_back({group.by, std::move(*scale)});
  }
  const Findings findings = findings_of(scales);
  return write_fit(o, findings, preferences_report(o, scales, findings.verdict()), json);
}

Result<Report> run_fit(const FitOptions& o, bool json) {
  if (o.fit.guess && !(*o.fit.guess >= 0 && *o.fit.guess < 1))
    return schema::fail(ErrorKind::usage, "is not from 0 % to below 100 %", "--guess",
                        "give the share that is right by guessing: 50% for two alternatives");
  if (o.fit.lapse && !(*o.fit.lapse >= 0 && *o.fit.lapse < (1 - o.fit.guess.value_or(0)) / 2))
    return schema::fail(ErrorKind::usage, "is not from 0 % to half of what guessing leaves", "--lapse",
                        "give for example 2%");
  const Findings nothing_yet;
  const OutputKind svg = svg_output(nothing_yet);
  TACTO_TRY(check_outputs(o.outputs, o.existing, {&svg, 1}));
  return o.pairs ? fit_pairs(o, json) : fit_levels(o, json);
}

cli::Action declare_fit(CLI::App& app) {
  auto options = std::make_shared<FitOptions>();
  app.add_option("FILE", options->file, "Table of answers (CSV)")->required();
  app.add_option("--by", options->columns.by,
                 "Columns whose values divide the rows into groups: PERSON,CONDITION")
      ->delimiter(',');
  cli::add_quantity(app, "--guess", options->fit.guess, schema::Dimension::share,
                    "Share of answers that are right by guessing; default: two stimuli are compared");
  cli::add_quantity(app, "--lapse", options->fit.lapse, schema::Dimension::share,
                    "Fix the lapse rate; default: fitted, with the prior Beta(1, 19)");
  app.add_flag("--overdispersed", options->fit.overdispersed,
               "Answers at one level scatter more than independent ones: beta-binomial");
  cli::add_choice<Shape>(
      app, "--function", options->fit.shape,
      {{"normal", Shape::normal}, {"logistic", Shape::logistic}, {"weibull", Shape::weibull}},
      "Psychometric function");
  app.add_option("--level", options->columns.level, "Column of the level");
  CLI::Option* yes = app.add_option("--yes", options->columns.yes, "Column of the answers that are counted");
  CLI::Option* no = app.add_option("--no", options->columns.no, "Column of the other answers");
  CLI::Option* trials = app.add_option("--trials", options->columns.trials, "Column of the number of trials");
  no->excludes(trials);
  CLI::Option* pairs = app.add_flag("--pairs", options->pairs, "The table has paired comparisons");
  for (const char* name : {"--guess", "--lapse", "--overdispersed", "--function", "--level"})
    pairs->excludes(app.get_option(name));
  pairs->excludes(yes)->excludes(no)->excludes(trials);
  app.add_option(
      "-o,--output", options->outputs,
      "Output: a page (.html), results for 'report' (.results.json), or a single picture (.svg); may "
      "be repeated");
  cli::declare_force(app, options->existing);
  app.footer(kFitHelp);
  CLI::App* const verb = app.get_parent();
  return [options, verb] { return run_fit(*options, verb->count("--json") > 0); };
}

struct AnalyseOptions {
  FitOptions fit;
  bool unblind = false;
};

// The table of confusions, for --json and results.
Report confusion_report(const IdentificationAnswers& all, const ConfusionMatrix& matrix) {
  Report report;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    Report row;
    for (std::size_t j = 0; j < matrix[i].size(); ++j) row.add(all.standards[j], matrix[i][j]);
    report.add(all.comparisons[i], std::vector<Report>{row});
  }
  return report;
}

void add_information(Report& row, const std::optional<Information>& information) {
  if (!information) return;
  row.add("information_bit", information->jackknife)
      .add("plug_in_bit", information->plug_in)
      .add("miller_madow_bit", information->miller_madow);
}

Report identification_report(const IdentificationAnswers& all, const std::string& verdict) {
  Report report;
  report.add("verdict", verdict);
  if (!all.simulated.empty()) report.add("simulated", all.simulated);
  if (all.abandoned > 0) report.add("abandoned", all.abandoned);
  if (all.timed_out > 0) report.add("after_time_limit", all.timed_out);
  std::vector<Report> people, conditions;
  for (const BlockAnswers& each : all.blocks) {
    Report& row = people.emplace_back();
    row.add("participant", each.participant).add("condition", each.condition).add("block", each.block);
    row.add("trials", each.trials).add("success", each.success);
    add_information(row, each.information);
    row.add("answers", std::vector<Report>{confusion_report(all, each.matrix)});
  }
  for (const BlocksOverPeople& over : blocks_over_people(all)) {
    Report& row = conditions.emplace_back();
    row.add("condition", over.condition).add("people", over.people).add("success", over.success);
    if (over.success_deviation) row.add("success_deviation", *over.success_deviation);
    add_information(row, over.information);
    row.add("answers", std::vector<Report>{confusion_report(all, over.matrix)});
  }
  return report.add("conditions", std::move(conditions)).add("people", std::move(people));
}

void add_matched(Report& row, const MatchedPerson& each) {
  row.add("trials", each.ratings.size()).add("rated_0", each.rated_0);
  if (each.mean_at_0) row.add("mean_ratio_at_0", *each.mean_at_0);
  if (each.match) add_estimate(row, "match", *each.match);
}

Report amplitude_report(const AmplitudeAnswers& all, const std::string& verdict) {
  Report report;
  report.add("verdict", verdict);
  if (!all.simulated.empty()) report.add("simulated", all.simulated);
  if (all.mean_at_0) report.add("mean_ratio_at_0", *all.mean_at_0);
  if (all.match) add_estimate(report, "match", *all.match);
  std::vector<Report> people;
  for (const MatchedPerson& each : all.people) {
    Report& row = people.emplace_back();
    row.add("participant", each.participant);
    add_matched(row, each);
  }
  return report.add("people", std::move(people));
}

void add_same(Report& row, const SameAnswers& answers, const std::optional<Estimate>& d_prime) {
  row.add("same_of_own", answers.same_of_own).add("own", answers.own);
  row.add("same_of_other", answers.same_of_other).add("other", answers.other);
  if (d_prime) add_estimate(row, "d_prime", *d_prime);
}

Report fidelity_report(const FidelityAnswers& all, const std::string& verdict) {
  Report report;
  report.add("verdict", verdict);
  if (!all.simulated.empty()) report.add("simulated", all.simulated);
  if (all.abandoned > 0) report.add("abandoned", all.abandoned);
  add_same(report, sum_of(all), all.d_prime);
  if (all.predicted_error_db) report.add("predicted_error_db", *all.predicted_error_db);
  std::vector<Report> pairs, people;
  for (std::size_t played = 0; played < all.standards.size(); ++played)
    for (std::size_t sample = 0; sample < all.standards.size(); ++sample) {
      const SameAnswers& pair = all.pairs[played][sample];
      pairs.emplace_back().add("played", all.standards[played]).add("sample", all.standards[sample]);
      pairs.back().add("same", pair.same_of_own + pair.same_of_other).add("trials", pair.own + pair.other);
    }
  for (const FidelityPerson& each : all.people)
    add_same(people.emplace_back().add("participant", each.participant), each.answers, each.d_prime);
  return report.add("pairs", std::move(pairs)).add("people", std::move(people));
}

void add_ordered(Report& row, const OrderingAnswers& all, const OrderedBy& by) {
  row.add("orders", by.orders);
  Report ranks;
  for (std::size_t i = 0; i < all.standards.size(); ++i) ranks.add(all.standards[i], by.mean_ranks[i]);
  row.add("mean_ranks", std::vector<Report>{ranks});
  if (by.agreement)
    row.add("w", by.agreement->w)
        .add("chi_squared", by.agreement->chi_squared)
        .add("degrees_of_freedom", by.agreement->freedom)
        .add("p", by.agreement->p);
  if (by.intended) row.add("spearman_rho", by.intended->rho).add("kendall_tau", by.intended->tau);
}

Report ordering_report(const OrderingAnswers& all, const std::string& verdict) {
  Report report;
  report.add("verdict", verdict);
  if (!all.simulated.empty()) report.add("simulated", all.simulated);
  if (all.abandoned > 0) report.add("abandoned", all.abandoned);
  Report over;
  add_ordered(over, all, all.all);
  report.add("over_people", std::vector<Report>{over});
  std::vector<Report> people;
  for (const OrderedBy& each : all.people) {
    people.emplace_back().add("participant", each.participant);
    add_ordered(people.back(), all, each);
  }
  return report.add("people", std::move(people));
}

void add_series(Report& row, const std::string& key, const std::optional<SeriesMean>& series) {
  if (!series) return;
  row.add(key + "_settings", series->settings);
  add_estimate(row, key, series->ratio);
  if (series->deviation_db) row.add(key + "_deviation_db", *series->deviation_db);
}

Report adjustment_report(const AdjustmentAnswers& all, const std::string& verdict) {
  Report report;
  report.add("verdict", verdict).add("goal", schema::word_of(all.goal));
  if (!all.simulated.empty()) report.add("simulated", all.simulated);
  if (all.abandoned > 0) report.add("abandoned", all.abandoned);
  if (all.ratio) add_estimate(report, "ratio", *all.ratio);
  if (all.ratio) report.add("rms_m", all.unit_rms_m * all.ratio->value).add("rms_band", all.band);
  if (all.hysteresis_db) add_estimate(report, "hysteresis_db", *all.hysteresis_db);
  std::vector<Report> people;
  for (const AdjustedPerson& each : all.people) {
    Report& row = people.emplace_back();
    row.add("participant", each.participant).add("bounds", each.bounds);
    if (each.means.middle) add_estimate(row, "ratio", *each.means.middle);
    add_series(row, "ascending", each.means.ascending);
    add_series(row, "descending", each.means.descending);
    if (each.means.hysteresis_db) add_estimate(row, "hysteresis_db", *each.means.hysteresis_db);
  }
  return report.add("people", std::move(people));
}

Result<Report> analyse_task(const AnalyseOptions& o, bool json) {
  const auto protocol = schema::read_protocol(o.fit.file);
  TACTO_TRY(protocol);
  if (protocol->task == schema::Task::two_interval) {
    auto table = study_answers(o.fit.file, o.unblind);
    TACTO_TRY(table);
    return fit_table(o.fit, std::move(*table), json);
  }
  const auto runs = answered_runs(o.fit.file, o.unblind);
  TACTO_TRY(runs);
  if (protocol->task == schema::Task::amplitude) {
    const AmplitudeAnswers answers = amplitude_answers(*runs);
    const Findings findings = findings_of(answers);
    return write_fit(o.fit, findings, amplitude_report(answers, findings.verdict()), json);
  }
  if (protocol->task == schema::Task::fidelity) {
    const FidelityAnswers answers = fidelity_answers(*runs);
    const Findings findings = findings_of(answers);
    return write_fit(o.fit, findings, fidelity_report(answers, findings.verdict()), json);
  }
  if (protocol->task == schema::Task::ordering) {
    const OrderingAnswers answers = ordering_answers(*runs);
    const Findings findings = findings_of(answers);
    return write_fit(o.fit, findings, ordering_report(answers, findings.verdict()), json);
  }
  if (protocol->task == schema::Task::adjustment) {
    const auto answers = adjustment_answers(*runs);
    TACTO_TRY(answers);
    const Findings findings = findings_of(*answers);
    return write_fit(o.fit, findings, adjustment_report(*answers, findings.verdict()), json);
  }
  const IdentificationAnswers answers = identification_answers(*runs);
  const Findings findings = findings_of(answers);
  return write_fit(o.fit, findings, identification_report(answers, findings.verdict()), json);
}

Result<Report> run_analyse(const AnalyseOptions& o, bool json) {
  const Findings nothing_yet;
  const OutputKind svg = svg_output(nothing_yet);
  TACTO_TRY(check_outputs(o.fit.outputs, o.fit.existing, {&svg, 1}));
  auto report = analyse_task(o, json);
  TACTO_TRY(report);
  if (!o.fit.outputs.empty()) TACTO_TRY(log_outputs(schema::stem_of(o.fit.file, ".protocol"), o.fit.outputs));
  const auto protocol = schema::read_protocol(o.fit.file);
  TACTO_TRY(protocol);
  if (!protocol->analysis.empty()) report->add("intended_analysis", protocol->analysis);
  return report;
}

cli::Action declare_analyse(CLI::App& app) {
  auto options = std::make_shared<AnalyseOptions>();
  options->fit.verb = "experiment analyse";
  app.add_option("STUDY", options->fit.file, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_flag("--unblind", options->unblind,
               "Analyse before the planned participants are complete; STUDY.unblinded.txt keeps the date");
  app.add_option("-o,--output", options->fit.outputs,
                 "Output: a page (.html), results for 'report' (.results.json), or a single picture (.svg); "
                 "may be repeated");
  cli::declare_force(app, options->fit.existing);
  app.footer(
      "The trials that were delivered and answered, of all participants. Of two intervals: the JND is the "
      "Weber fraction, re the standard's period; where all stretches have one sign (a staircase) the PSE is "
      "0 and "
      "not fitted.\nOf an identification: success and transmitted information "
      "of "
      "real and of virtual comparisons, each person analysed and then the mean taken; information is "
      "corrected for its bias by the jackknife, with the plug-in value and that of Miller and Madow beside "
      "it; "
      "the answers are the sum over people.\nOf fidelity: how often a played texture was "
      "called the same as its own sample, and as another one; d' of the yes-no decision, with the mean over "
      "people and "
      "Student's interval; and the median of the predicted error.\nOf amplitude: the mean ratio of the "
      "trials that were rated 0, "
      "and the "
      "fitted match, the ratio at the middle of what is rated 0: it does not depend on which ratios were "
      "asked. Its "
      "model: normal errors; two limits, below and above which the rating is not 0; lapses at both ends "
      "alike, with "
      "the prior Beta(1, 19). Median and 95 % interval of the posterior; of several people the geometric "
      "mean of "
      "their matches, by Student's t.\nOf ordering: the mean ranks over people, Kendall's W of their mean "
      "ranks, "
      "and the correlation of the mean ranks with the intended parameter.\nOf adjustment: the geometric mean "
      "of "
      "the ratios that were accepted, in ascending and in descending series, with Student's 95 % interval; "
      "the "
      "middle of both, and their difference with an interval after Welch. A setting at an end of the range "
      "is "
      "a bound, and counted.");
  CLI::App* const verb = app.get_parent();
  return [options, verb] { return run_analyse(*options, verb->count("--json") > 0); };
}

constexpr cli::VerbPart kExperimentParts[] = {
    {"new", "Write a protocol, its stimuli under codes, and the key of the codes", declare_new_study},
    {"check", "Check a study's files: protocol, key, stimuli", declare_check_study},
    {"run", "Run a study with one participant, or with a simulated observer", declare_run_study},
    {"resume", "Continue an interrupted run", declare_resume_study},
    {"noise", "Write the masking noise of a study as WAV", declare_noise},
    {"watch", "Print the progress of a study's runs while they go on", declare_watch_study},
    {"prove", "Compute from the sessions of a run what was delivered", declare_prove_run},
    {"analyse",
     "Fit psychometric functions to the answers of a study, count confusions, find a match or an order",
     declare_analyse},
    {"power", "How many participants a study needs for a difference of Weber fractions", declare_study_power},
    {"export", "Write the trials of a study as CSV and BIDS, with a script for R", declare_export_study},
    {"withdraw", "Delete all files of a participant; code and date are noted", declare_withdraw},
    {"fit", "Fit psychometric functions, or a scale, to a table of answers", declare_fit},
};

cli::Action declare_experiment(CLI::App& app) {
  return cli::declare_parts(app, kExperimentParts);
}

}  // namespace

const cli::Verb kExperimentVerb{
    "experiment", "Psychophysics: run a protocol, prove what was delivered, fit the answers",
    "tactograph experiment new stretch --pacing-cue -o stretch\n"
    "  tactograph experiment check stretch -d usb:\n"
    "  tactograph experiment run stretch -d usb: --participant P01\n"
    "  tactograph experiment run stretch -d sim: --participant P02 --observer weber=25%,lapse=2%\n"
    "  tactograph experiment resume stretch-P01\n"
    "  tactograph experiment watch stretch\n"
    "  tactograph experiment prove stretch-P01\n"
    "  tactograph experiment analyse stretch --unblind -o stretch.html\n"
    "  tactograph experiment power stretch --weber 15.5%,25.3% --spread 23%\n"
    "  tactograph experiment export stretch -o stretch-export\n"
    "  tactograph experiment withdraw stretch --participant P07\n"
    "  tactograph experiment new identification --textures A,B,C,D,E --comparisons C,D,E -o surfaces\n"
    "  tactograph experiment run surfaces -d sim: --participant P01 --observer template\n"
    "  tactograph experiment new fidelity --textures A,C,E -o bench\n"
    "  tactograph experiment run bench -d sim: --participant P01 --observer template\n"
    "  tactograph experiment new amplitude --textures E -o amplitude\n"
    "  tactograph experiment run amplitude -d sim: --participant P01 --observer match=86%,weber=10%\n"
    "  tactograph experiment new ordering --textures A,C,E --intended 0.2,0.5,1 -o roughness\n"
    "  tactograph experiment run roughness -d sim: --participant P01 --observer order,noise=1dB\n"
    "  tactograph experiment new adjustment --textures E --goal least -o least\n"
    "  tactograph experiment run least -d sim: --participant P01 --observer threshold=20%,sd=10%\n"
    "  tactograph experiment new stretch --masking-noise 65dB --normal-force 0.3N,0.8N -o quiet\n"
    "  tactograph experiment noise quiet -o noise.wav\n"
    "  tactograph experiment run quiet -d usb: --participant P01 --masking-level 64.5dB\n"
    "  tactograph experiment prove sessions/2026-11-29.session\n"
    "  tactograph experiment fit answers.csv --guess 50% -o answers.html\n"
    "  tactograph experiment fit answers.csv --by participant,vibration_hz\n"
    "  tactograph experiment fit --pairs preferences.csv",
    declare_experiment};

}  // namespace tacto::analysis
