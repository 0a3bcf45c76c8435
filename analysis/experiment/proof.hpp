// SPDX-License-Identifier: GPL-3.0-or-later
// What the sessions of a run prove, computed again; and the run as a table.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/study.hpp"
#include "analysis/experiment/trial_queue.hpp"

namespace tacto::analysis {

/// A run with all that belongs to it.
struct Run {
  std::string stem;  ///< STUDY-P07
  schema::Journal journal;
  Study study;
  TrialQueue queue;
};

/// `name`: STUDY-P07 or its journal; the study is in the same folder. Errors: those of read_journal,
/// read_study; unsuitable: protocol or key have changed since the run began, an entry that does not follow, a
/// participant who has withdrawn.
schema::Result<Run> read_run(const std::string& name);
/// The same for a journal that was read already.
schema::Result<Run> run_of(const std::string& stem, schema::Journal journal);

/// How far the predicted stretch may be from the nominal one.
inline constexpr double kStretchTolerance = 0.01;

struct Proof {
  std::size_t trials = 0;                                 ///< planned; without those whose time was over
  std::size_t delivered = 0;                              ///< with an answer
  std::size_t attempts = 0, interrupted = 0, failed = 0;  ///< of the attempts: without answer; not delivered
  std::size_t sessions = 0, same_to_the_bit = 0;
  std::size_t placed = 0;  ///< answered real samples: what they were is the operator's word
  /// Largest |predicted - nominal| of those delivered; none in an identification.
  std::optional<double> stretch_error;
  std::vector<std::string> faults;  ///< what differs from the journal, session by session
  std::string simulated;

  bool holds() const {
    return faults.empty() && same_to_the_bit == sessions && stretch_error.value_or(0) <= kStretchTolerance;
  }
};

/// Computes the facts of every judged attempt from its sessions, decides again, and replays each session.
/// `tell` receives 0 to 1.
Proof prove(const Run& run, const std::function<void(double)>& tell);

/// Of a trial of two intervals: predicted period of the stretched stimulus over that of the standard, minus
/// 1; none: a period is unknown.
std::optional<double> predicted_stretch(const Attempt& attempt);

/// STUDY-P07.trials.tsv: a row for each attempt. Its columns are those of the task.
std::string trials_table(const Run& run);

}  // namespace tacto::analysis
