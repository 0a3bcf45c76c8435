// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of all participants of a study, for the fit.
#pragma once

#include <string>

#include "analysis/experiment/answers_table.hpp"

namespace tacto::analysis {

/// Of each run STUDY-*.trials.jsonl, by the stretch of the period: how often the stretched stimulus seemed
/// the longer one, among the trials that were delivered and answered. Before as many runs are complete as the
/// protocol plans, the answers are given only to `unblind`, and STUDY.unblinded.txt keeps when that was.
/// Errors: those of read_study and read_run; unsuitable: no answers, not enough complete runs; cannot_write.
schema::Result<AnswersTable> study_answers(const std::string& study, bool unblind);

}  // namespace tacto::analysis
