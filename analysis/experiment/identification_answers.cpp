// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/identification_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/experiment/study_answers.hpp"

namespace tacto::analysis {
namespace {

std::size_t number_of_name(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

ConfusionMatrix empty_matrix(const IdentificationAnswers& all) {
  return ConfusionMatrix(all.comparisons.size(), std::vector<double>(all.standards.size(), 0));
}

BlockAnswers& block_of(IdentificationAnswers& all, const Run& run, const StudyTrial& trial) {
  const std::string& participant = run.journal.plan.participant;
  for (BlockAnswers& each : all.blocks)
    if (each.participant == participant && each.block == trial.block) return each;
  BlockAnswers& block = all.blocks.emplace_back();
  block.participant = participant;
  block.condition = trial.real ? schema::kRealCondition : schema::kVirtualCondition;
  block.block = trial.block;
  block.matrix = empty_matrix(all);
  return block;
}

bool has_information(const ConfusionMatrix& matrix) {
  return std::ranges::all_of(
      matrix, [](const auto& row) { return std::accumulate(row.begin(), row.end(), 0.0) >= 2; });
}

std::string information_in_words(const std::optional<Information>& information) {
  if (!information) return "unknown: a comparison has fewer than two answers";
  return fmt::format("{:.3f} bit (jackknife; plug-in {:.3f}, Miller-Madow {:.3f})", information->jackknife,
                     information->plug_in, information->miller_madow);
}

std::string success_in_words(const BlocksOverPeople& over) {
  return over.success_deviation ? fmt::format("{:.3f} +- {:.3f}", over.success, *over.success_deviation)
                                : fmt::format("{:.3f}", over.success);
}

std::string matrix_in_words(const IdentificationAnswers& all, const ConfusionMatrix& matrix) {
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    std::vector<std::string> cells;
    for (std::size_t j = 0; j < matrix[i].size(); ++j)
      cells.push_back(fmt::format("{} {:g}", all.standards[j], matrix[i][j]));
    rows.push_back(fmt::format("{} answered as {}", all.comparisons[i], fmt::join(cells, ", ")));
  }
  return fmt::format("{}", fmt::join(rows, "; "));
}

std::vector<std::vector<std::string>> people_table(const IdentificationAnswers& all) {
  std::vector<std::vector<std::string>> rows = {
      {"participant", "condition", "block", "trials", "success", "transmitted information"}};
  for (const BlockAnswers& each : all.blocks)
    rows.push_back({each.participant, each.condition, fmt::format("{}", each.block),
                    fmt::format("{:g}", each.trials), fmt::format("{:.3f}", each.success),
                    information_in_words(each.information)});
  return rows;
}

}  // namespace

IdentificationAnswers identification_answers(const std::vector<Run>& runs) {
  IdentificationAnswers all;
  all.comparisons = runs.front().study.protocol.comparisons;
  all.standards = runs.front().study.protocol.standards;
  std::vector<std::string> simulated;
  for (const Run& run : runs) {
    add_simulated(simulated, run);
    all.abandoned += run.queue.abandoned(), all.timed_out += run.queue.timed_out();
    for (const Attempt& attempt : run.queue.attempts()) {
      if (!attempt.counts()) continue;
      BlockAnswers& block = block_of(all, run, attempt.trial);
      const std::string& presented = stimulus_of(run.study.key, attempt.trial.code).name;
      const auto choice = static_cast<std::size_t>(attempt.answered->choice) - 1;
      block.matrix[number_of_name(all.comparisons, presented)][choice] += 1;
      block.success += all.standards[choice] == presented ? 1 : 0;
      block.trials += 1;
    }
  }
  for (BlockAnswers& each : all.blocks) {
    each.success /= each.trials;
    if (has_information(each.matrix)) each.information = information_of(each.matrix);
  }
  all.simulated = fmt::format("{}", fmt::join(simulated, "; "));
  return all;
}

std::vector<BlocksOverPeople> blocks_over_people(const IdentificationAnswers& all) {
  std::vector<BlocksOverPeople> blocks;
  for (const char* const name : {schema::kRealCondition, schema::kVirtualCondition}) {
    BlocksOverPeople over{name, 0, 0, {}, Information{}, empty_matrix(all)};
    double squares = 0;
    for (const BlockAnswers& each : all.blocks) {
      if (each.condition != name) continue;
      ++over.people;
      over.success += each.success, squares += each.success * each.success;
      if (!each.information) over.information.reset();
      if (over.information)
        for (const auto member : {&Information::plug_in, &Information::miller_madow, &Information::jackknife})
          *over.information.*member += *each.information.*member;
      for (std::size_t i = 0; i < over.matrix.size(); ++i)
        for (std::size_t j = 0; j < over.matrix[i].size(); ++j) over.matrix[i][j] += each.matrix[i][j];
    }
    if (over.people == 0) continue;
    const auto people = static_cast<double>(over.people);
    over.success /= people;
    if (over.people > 1)
      over.success_deviation =
          std::sqrt(std::max(squares - people * over.success * over.success, 0.0) / (people - 1));
    if (over.information)
      for (const auto member : {&Information::plug_in, &Information::miller_madow, &Information::jackknife})
        *over.information.*member /= people;
    blocks.push_back(std::move(over));
  }
  return blocks;
}

Findings findings_of(const IdentificationAnswers& all) {
  Findings findings;
  findings.figures.push_back({"verdict", ""});
  std::vector<std::string> verdicts;
  for (const BlocksOverPeople& over : blocks_over_people(all)) {
    verdicts.push_back(fmt::format("success {} with {} comparisons", success_in_words(over), over.condition));
    findings.figures.push_back(
        {over.condition + ", success",
         fmt::format("{} ({}, chance {:.3g})", success_in_words(over),
                     over.people == 1 ? "one person"
                                      : fmt::format("mean and standard deviation of {} people", over.people),
                     1 / static_cast<double>(all.standards.size()))});
    findings.figures.push_back(
        {over.condition + ", transmitted information",
         information_in_words(over.information) + (over.people > 1 ? ", mean over people" : "")});
    findings.figures.push_back({over.condition + ", answers", matrix_in_words(all, over.matrix)});
  }
  if (all.abandoned > 0)
    findings.figures.push_back(
        {"abandoned",
         fmt::format("{} trials, after too many attempts that were not delivered", all.abandoned)});
  if (all.timed_out > 0)
    findings.figures.push_back(
        {"after the time limit", fmt::format("{} trials, which were left out", all.timed_out)});
  findings.figures.front().value = fmt::format("{}", fmt::join(verdicts, "; "));
  findings.groups = people_table(all);
  findings.simulated = all.simulated;
  return findings;
}

}  // namespace tacto::analysis
