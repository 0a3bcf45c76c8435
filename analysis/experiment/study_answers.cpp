// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/study_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "analysis/experiment/adaptive_levels.hpp"
#include "analysis/experiment/withdrawal.hpp"
#include "data-schema/base/creation_time.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

AnswerGroup<LevelCount> answers_of_run(const Run& run) {
  std::map<double, LevelCount> levels;
  for (const Attempt& attempt : run.queue.attempts()) {
    if (!attempt.counts()) continue;
    const double stretch = stimulus_of(run.study.key, attempt.trial.code).stretch;
    LevelCount& level = levels[stretch];
    level.level = stretch;
    level.yes += seemed_longer(attempt) ? 1 : 0;
    level.trials += 1;
  }
  AnswerGroup<LevelCount> group{{run.journal.plan.participant}, {}};
  for (const auto& [stretch, level] : levels) group.rows.push_back(level);
  return group;
}

std::string reversals_in_words(const Run& run) {
  const auto reversals = reversals_of(run.study.protocol, run.study.key, run.queue.attempts());
  double mean = 0;
  for (const double stretch : reversals) mean += stretch / static_cast<double>(reversals.size());
  if (reversals.empty()) return run.journal.plan.participant + ": none";
  return fmt::format("{}: {:.3g}, mean of {} reversals", run.journal.plan.participant, mean,
                     reversals.size());
}

// Reads the file and writes it with a further line.
Result<void> log_unblinding(const Study& study, std::size_t complete) {
  const std::string path = study.stem + ".unblinded.txt";
  std::string text = schema::is_file(path) ? schema::read_file(path).value_or("") : "";
  text += fmt::format("{}\t{} of {} planned participants complete\n", schema::creation_time(), complete,
                      study.protocol.participants);
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(path, text));
  return pending.commit();
}

}  // namespace

std::vector<std::string> runs_of(const Study& study) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(study.stem).parent_path();
  std::vector<std::string> runs;
  std::error_code ignored;
  for (const auto& file : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, ignored)) {
    const std::string name = file.path().filename().string();
    if (!name.starts_with(study.name() + "-") || schema::run_stem(name) == name) continue;
    const std::string participant = schema::run_stem(name).substr(study.name().size() + 1);
    if (schema::check_participant(participant) && !is_withdrawn(study.stem, participant))
      runs.push_back(study.run(participant));
  }
  std::ranges::sort(runs);
  return runs;
}

void add_simulated(std::vector<std::string>& all, const Run& run) {
  const auto add = [&](const std::string& what) {
    if (std::ranges::find(all, what) == all.end()) all.push_back(what);
  };
  if (const std::string observer = observer_in_words(run); !observer.empty()) add(observer);
  for (const Attempt& attempt : run.queue.attempts())
    if (attempt.judged)
      for (const schema::IntervalFacts& facts : attempt.judged->intervals)
        if (!facts.simulated.empty()) add(facts.simulated);
}

// Interval `choice` has the smaller period by the answer: whether that is the standard's.
bool seemed_longer(const Attempt& attempt) {
  return attempt.trial.standard_comes_first() == (attempt.answered->choice == 1);
}

std::optional<double> known_pse(const schema::Protocol& protocol) {
  const bool one_sign = protocol.levels.front() > 0 || protocol.levels.back() < 0;
  return one_sign ? std::optional(0.0) : std::nullopt;
}

Result<std::vector<Run>> answered_runs(const std::string& name, bool unblind) {
  const auto study = read_study(name);
  TACTO_TRY(study);
  std::vector<Run> runs;
  std::size_t complete = 0;
  for (const std::string& stem : runs_of(*study)) {
    auto run = read_run(stem);
    TACTO_TRY(run);
    complete += run->queue.has_ended();
    if (run->queue.counted() > 0) runs.push_back(std::move(*run));
  }
  if (runs.empty()) return fail(ErrorKind::unsuitable, "has no answers yet", study->stem, "run it first");
  if (complete < static_cast<std::size_t>(study->protocol.participants)) {
    if (!unblind)
      return fail(
          ErrorKind::unsuitable,
          fmt::format("{} of {} planned participants are complete", complete, study->protocol.participants),
          study->stem, "wait for the others; --unblind analyses now, and that is logged");
    TACTO_TRY(log_unblinding(*study, complete));
  }
  return runs;
}

Result<AnswersTable> study_answers(const std::string& name, bool unblind) {
  const auto runs = answered_runs(name, unblind);
  TACTO_TRY(runs);
  AnswersTable table;
  table.of_study = true;
  std::vector<std::string> simulated;
  for (const Run& run : *runs) {
    table.groups.push_back(answers_of_run(run));
    if (run.study.protocol.method == schema::LevelMethod::staircase)
      table.reversals.push_back(reversals_in_words(run));
    add_simulated(simulated, run);
  }
  table.pse = known_pse(runs->front().study.protocol);
  table.columns.by = {"participant"};
  table.columns.level = table.level_name = "stretch of the period (0.3: 30 % longer)";
  table.columns.yes = "seemed longer";
  table.simulated = fmt::format("{}", fmt::join(simulated, "; "));
  return table;
}

}  // namespace tacto::analysis
