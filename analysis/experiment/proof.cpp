// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/proof.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "analysis/experiment/interval_facts.hpp"
#include "analysis/experiment/live_setting.hpp"
#include "analysis/experiment/trial_runner.hpp"
#include "analysis/experiment/withdrawal.hpp"
#include "playback/session/session_replay.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr const char *kStretchColumns =
                         "standard_interval\tnominal_stretch\tpredicted_stretch\tmeasured_stretch",
                     *kIdentificationColumns = "block\tcondition\tpresented",
                     *kAmplitudeColumns = "nominal_ratio\tpredicted_ratio\tmeasured_ratio",
                     *kOrderingColumns = "explorations", *kFidelityColumns = "block\tsample\tpresented",
                     *kAdjustmentColumns = "series\tstart_ratio\tpredicted_ratio\tmeasured_ratio\tbound";
constexpr const char* kTrialColumns =
    "attempt\ttrial\t{}\tpredicted_error_db\tmeasured_error_db\t{}{}\tanswer\tanswer_s\tdelivered\twhy\t"
    "simulated\n";
constexpr const char* kPlacedReason = "real sample, placed by the operator: no session records it";

schema::Task task_of(const Run& run) {
  return run.study.protocol.task;
}

std::string folder_with(const std::string& stem) {
  const auto folder = std::filesystem::path(stem).parent_path().string();
  return folder.empty() ? "" : folder + "/";
}

// Reasons that no session contains.
std::vector<std::string> other_reasons(const schema::DeliveryJudged& judged) {
  std::vector<std::string> others;
  for (const std::string& reason : judged.why)
    if (!reason.starts_with("interval ")) others.push_back(reason);
  return others;
}

class Prover {
 public:
  Prover(const Run& run, Proof& proof) : run_(run), proof_(proof) {}

  void take(const Attempt& attempt) {
    const bool practice = attempt.trial.is_practice();  // its sessions are proven, too
    if (!practice && !attempt.answered) ++proof_.interrupted;
    if (!practice && attempt.placed && attempt.answered) ++proof_.placed;
    if (!attempt.judged) return;
    if (!practice && !attempt.judged->delivered) ++proof_.failed;
    std::vector<schema::IntervalFacts> facts;
    for (std::size_t i = 0; i < attempt.judged->intervals.size(); ++i)
      if (auto again = facts_again(attempt, i)) facts.push_back(std::move(*again));
    if (facts.size() < attempt.judged->intervals.size()) return;
    compare(attempt, std::move(facts));
  }

 private:
  std::optional<schema::IntervalFacts> facts_again(const Attempt& attempt, std::size_t interval) {
    const std::string session = folder_with(run_.stem) + attempt.begun.sessions[interval];
    ++proof_.sessions;
    auto facts = interval_facts(session);
    if (!facts) {
      proof_.faults.push_back(schema::message(facts.error()));
      return std::nullopt;
    }
    if (!facts->simulated.empty()) proof_.simulated = facts->simulated;
    const auto replayed = playback::replay_session(session);
    const bool damaged = !replayed || replayed->first_difference || replayed->damaged_at;
    if (replayed && replayed->same())
      ++proof_.same_to_the_bit;
    else if (!damaged && !attempt.judged->delivered)
      ++proof_.same_until_lost;
    else
      proof_.faults.push_back(session + ": computed again, its drive is not the same to the bit");
    return std::move(*facts);
  }

  void compare(const Attempt& attempt, std::vector<schema::IntervalFacts> facts) {
    std::vector<std::string> sums;
    for (const std::string& code : attempt.begun.stimuli)
      sums.push_back(stimulus_of(run_.study.key, code).sha256);
    Attempt again = attempt;
    again.judged = judged_delivery(attempt.begun.attempt, std::move(facts), sums, run_.study.protocol,
                                   other_reasons(*attempt.judged));
    if (again.judged->why != attempt.judged->why)
      proof_.faults.push_back(fmt::format("attempt {}: its sessions say '{}', the journal '{}'",
                                          attempt.begun.attempt, fmt::join(again.judged->why, "; "),
                                          fmt::join(attempt.judged->why, "; ")));
    if (!again.counts()) return;
    ++proof_.delivered;
    if (task_of(run_) == schema::Task::adjustment && accepted_ratio(again) != accepted_ratio(attempt))
      proof_.faults.push_back(fmt::format("attempt {}: its session does not end with the gain of the journal",
                                          attempt.begun.attempt));
    if (task_of(run_) == schema::Task::amplitude || task_of(run_) == schema::Task::adjustment)
      compare_ratio(again);
    if (task_of(run_) != schema::Task::two_interval) return;
    const double nominal = stimulus_of(run_.study.key, attempt.trial.code).stretch;
    take_error(stretch_by(Displacement::measured, again), nominal, proof_.measured_stretch_error);
    if (!take_error(stretch_by(Displacement::predicted, again), nominal, proof_.stretch_error))
      proof_.faults.push_back(fmt::format("attempt {}: its sessions have no period", attempt.begun.attempt));
  }

  // False: the value is unknown.
  static bool take_error(const std::optional<double>& value, double expected,
                         std::optional<double>& largest) {
    if (value) largest = std::max(largest.value_or(0), std::abs(*value - expected));
    return value.has_value();
  }

  void compare_ratio(const Attempt& attempt) {
    const double asked = task_of(run_) == schema::Task::amplitude ? attempt.trial.ratio
                                                                  : accepted_ratio(attempt).value_or(NAN);
    take_error(ratio_by(Displacement::measured, run_, attempt), asked, proof_.measured_ratio_error);
    if (!take_error(ratio_by(Displacement::predicted, run_, attempt), asked, proof_.ratio_error))
      proof_.faults.push_back(
          fmt::format("attempt {}: its session does not say the gain", attempt.begun.attempt));
  }

  const Run& run_;
  Proof& proof_;
};

std::string level_cell(const Attempt& attempt, std::optional<double> schema::IntervalFacts::*member) {
  std::optional<double> worst;
  for (const schema::IntervalFacts& facts : attempt.judged->intervals) {
    if (!(facts.*member)) return "";
    worst = std::max(worst.value_or(-INFINITY), *(facts.*member));
  }
  return worst ? fmt::format("{:.9g}", *worst) : "";
}

std::string number_cell(const std::optional<double>& number) {
  return number ? fmt::format("{:.9g}", *number) : "";
}

// Of an adjustment: at which end of the range the accepted ratio is.
std::string bound_cell(const Run& run, const Attempt& attempt) {
  const auto ratio = accepted_ratio(attempt);
  if (!ratio || !attempt.answered || attempt.answered->choice == 0) return "";
  if (is_lowest(run.study.protocol, *ratio)) return "lower";
  return is_highest(run.study.protocol, *ratio) ? "upper" : "";
}

std::string cells_of_task(const Run& run, const Attempt& attempt) {
  if (task_of(run) == schema::Task::ordering) return fmt::format("{}", attempt.begun.stimuli.size());
  const schema::CodedStimulus& stimulus = stimulus_of(run.study.key, attempt.trial.code);
  const auto by = [&](Displacement which) {
    if (!attempt.judged) return std::string();
    return number_cell(task_of(run) == schema::Task::two_interval ? stretch_by(which, attempt)
                                                                  : ratio_by(which, run, attempt));
  };
  const std::string both = by(Displacement::predicted) + "\t" + by(Displacement::measured);
  if (task_of(run) == schema::Task::adjustment)
    return fmt::format("{}\t{:.9g}\t{}\t{}", attempt.trial.is_ascending() ? "ascending" : "descending",
                       attempt.trial.ratio, both, bound_cell(run, attempt));
  if (task_of(run) == schema::Task::amplitude) return fmt::format("{:.9g}\t{}", attempt.trial.ratio, both);
  if (task_of(run) == schema::Task::fidelity)
    return fmt::format("{}\t{}\t{}", attempt.trial.block,
                       stimulus_of(run.study.key, attempt.trial.sample).name, stimulus.name);
  if (task_of(run) == schema::Task::identification)
    return fmt::format("{}\t{}\t{}", attempt.trial.block,
                       attempt.trial.real ? schema::kRealCondition : schema::kVirtualCondition,
                       stimulus.name);
  return fmt::format("{}\t{:.9g}\t{}", attempt.trial.standard_comes_first() ? 1 : 2, stimulus.stretch, both);
}

// The answer as a number, or what stands for one.
std::string answer_cell(const Run& run, const Attempt& attempt) {
  if (task_of(run) == schema::Task::amplitude) return fmt::format("{}", rating_of(attempt));
  if (task_of(run) == schema::Task::adjustment) return number_cell(accepted_ratio(attempt));
  if (task_of(run) != schema::Task::ordering) return fmt::format("{}", attempt.answered->choice);
  std::vector<std::string> names;
  for (const std::string& code : codes_in(attempt.answered->word))
    names.push_back(stimulus_of(run.study.key, code).name);
  return fmt::format("{}", fmt::join(names, " "));
}

// The smallest share of the intervals.
std::string force_cell(const Attempt& attempt) {
  if (!attempt.judged) return "";
  double least = 1;
  for (const std::optional<double>& share : attempt.judged->force_within) {
    if (!share) return "unknown";
    least = std::min(least, *share);
  }
  return fmt::format("{:.3f}", least);
}

std::string trial_row(const Run& run, const Attempt& attempt) {
  std::string row =
      fmt::format("{}\t{}\t{}", attempt.begun.attempt, attempt.trial.name(), cells_of_task(run, attempt));
  for (const auto member :
       {&schema::IntervalFacts::predicted_error_db, &schema::IntervalFacts::measured_error_db})
    row += "\t" + (attempt.judged ? level_cell(attempt, member) : "");
  if (run.study.protocol.normal_force) row += "\t" + force_cell(attempt);
  if (const auto& answered = attempt.answered)
    row += fmt::format("\t{}\t{}\t{:.3f}", answer_cell(run, attempt), answered->word, answered->answer_s);
  else
    row += "\t\t\t";
  row += std::string("\t") + (!attempt.judged ? "unknown" : attempt.judged->delivered ? "yes" : "no");
  std::vector<std::string> why;
  if (attempt.placed) why.emplace_back(kPlacedReason);
  if (attempt.judged) why = attempt.judged->why;
  if (!attempt.answered) why.emplace_back("interrupted before the answer");
  row += fmt::format("\t{}\t{}", fmt::join(why, "; "), run.journal.plan.observer);
  return row;
}

}  // namespace

Result<void> check_unchanged(const schema::RunPlanned& plan, const Study& study) {
  const auto changed = [&](const std::string& path) {
    return fail(ErrorKind::unsuitable, fmt::format("has changed since the run of {} began", plan.participant),
                path, "take it from a copy; a changed protocol is a new study (new -o)");
  };
  if (plan.protocol_sha256 != study.protocol.sha256) return changed(schema::protocol_path(study.stem));
  if (plan.key_sha256 != study.key.sha256) return changed(schema::key_path(study.stem));
  return {};
}

Result<Run> read_run(const std::string& name) {
  auto journal = schema::read_journal(schema::journal_path(name));
  TACTO_TRY(journal);
  return run_of(schema::run_stem(name), std::move(*journal));
}

Result<Run> run_of(const std::string& stem, schema::Journal journal) {
  const std::string study_stem = folder_with(stem) + journal.plan.study;
  TACTO_TRY(check_not_withdrawn(study_stem, journal.plan.participant));
  auto study = read_study(study_stem);
  TACTO_TRY(study);
  TACTO_TRY(check_unchanged(journal.plan, *study));
  auto queue = queue_of(journal, study->protocol, study->key);
  if (!queue) queue.error().where = schema::journal_path(stem);
  TACTO_TRY(queue);
  return Run{stem, std::move(journal), std::move(*study), std::move(*queue)};
}

Proof prove(const Run& run, const std::function<void(double)>& tell) {
  Proof proof;
  proof.trials = run.queue.trials();
  proof.ratio_tolerance = kRatioTolerance * run.study.protocol.largest_ratio;
  proof.attempts = run.queue.tried();
  Prover prover(run, proof);
  double done = 0;
  for (const Attempt& attempt : run.queue.attempts()) {
    prover.take(attempt);
    tell(++done / static_cast<double>(run.queue.attempts().size()));
  }
  return proof;
}

std::optional<double> stretch_by(Displacement which, const Attempt& attempt) {
  if (attempt.judged->intervals.size() != 2) return std::nullopt;
  const auto period_m = which == Displacement::predicted ? &schema::IntervalFacts::predicted_period_m
                                                         : &schema::IntervalFacts::measured_period_m;
  const std::size_t standard = attempt.trial.standard_comes_first() ? 0 : 1;
  const auto& of_standard = attempt.judged->intervals[standard].*period_m;
  const auto& of_stretched = attempt.judged->intervals[1 - standard].*period_m;
  if (!of_standard || !of_stretched) return std::nullopt;
  return *of_stretched / *of_standard - 1;
}

std::optional<double> ratio_by(Displacement which, const Run& run, const Attempt& attempt) {
  if (attempt.judged->intervals.empty()) return std::nullopt;
  const schema::IntervalFacts& last = attempt.judged->intervals.back();
  const auto& gain_m_per_n =
      which == Displacement::predicted ? last.predicted_gain_m_per_n : last.measured_gain_m_per_n;
  if (!gain_m_per_n) return std::nullopt;
  return *gain_m_per_n / run.study.protocol.gain_m_per_n;
}

std::optional<double> accepted_ratio(const Attempt& attempt) {
  if (!attempt.judged || attempt.judged->intervals.empty()) return std::nullopt;
  return attempt.judged->intervals.back().last_gain;
}

int rating_of(const Attempt& attempt) {
  return attempt.answered->choice - 1 - schema::kLargestRating;
}

std::string observer_in_words(const Run& run) {
  const schema::RunPlanned& plan = run.journal.plan;
  if (plan.observer.empty()) return {};
  std::string words = fmt::format("observer {} ({})", plan.observer, plan.participant);
  if (run.queue.placed() > 0)
    words += ", which got the stored texture, without a device, in place of each real sample";
  return words;
}

std::string trials_table(const Run& run) {
  constexpr std::pair<const char*, const char*> kColumnsOfTask[] = {
      {kStretchColumns, "answer_interval"},   {kIdentificationColumns, "answer_choice"},
      {kAmplitudeColumns, "rating"},          {kOrderingColumns, "order"},
      {kAdjustmentColumns, "accepted_ratio"}, {kFidelityColumns, "answer_choice"}};
  const auto& [columns, answer] = kColumnsOfTask[static_cast<int>(task_of(run))];
  const char* const force = run.study.protocol.normal_force ? "force_within\t" : "";
  std::string table = fmt::format(kTrialColumns, columns, force, answer);
  for (const Attempt& attempt : run.queue.attempts())
    if (!attempt.trial.is_practice()) table += trial_row(run, attempt) + "\n";
  return table;
}

}  // namespace tacto::analysis
