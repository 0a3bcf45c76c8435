// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of all participants of a study, for the fit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/answers_table.hpp"
#include "analysis/experiment/proof.hpp"

namespace tacto::analysis {

/// STUDY-P01 ...: the runs of a study, in order, without those of who has withdrawn.
std::vector<std::string> runs_of(const Study& study);

/// By what a run is simulated, its answers and its device: adds to `all` what is not in it.
void add_simulated(std::vector<std::string>& all, const Run& run);

/// The runs STUDY-*.trials.jsonl of participants who have not withdrawn. Before as many are complete as the
/// protocol plans, they are given only to `unblind`, and STUDY.unblinded.txt keeps when that was. Errors:
/// those of read_study and read_run; unsuitable: no answers, not enough complete runs; cannot_write.
schema::Result<std::vector<Run>> answered_runs(const std::string& study, bool unblind);

/// Whether the stretched stimulus seemed to have the longer period. Precondition: an answer.
bool seemed_longer(const Attempt& attempt);

/// 0, where all stretches of the protocol have one sign: their answers cannot separate a bias from the JND.
/// Precondition: the task is two_interval.
std::optional<double> known_pse(const schema::Protocol& protocol);

/// Of those runs, by the stretch of the period: how often the stretched stimulus seemed the longer one, among
/// the trials that were delivered and answered. Errors: those of answered_runs.
/// Precondition: the task is two_interval.
schema::Result<AnswersTable> study_answers(const std::string& study, bool unblind);

}  // namespace tacto::analysis
