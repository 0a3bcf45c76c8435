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
/// Errors: unsuitable: the study's protocol or key is another one than that of the run.
schema::Result<void> check_unchanged(const schema::RunPlanned& plan, const Study& study);
/// The same for a journal that was read already.
schema::Result<Run> run_of(const std::string& stem, schema::Journal journal);

/// How far the predicted stretch may be from the nominal one, and the predicted ratio from the asked or the
/// accepted one, re the protocol's largest ratio.
inline constexpr double kStretchTolerance = 0.01;
inline constexpr double kRatioTolerance = 0.01;

struct Proof {
  std::size_t trials = 0;                                 ///< planned; without those whose time was over
  std::size_t delivered = 0;                              ///< with an answer
  std::size_t attempts = 0, interrupted = 0, failed = 0;  ///< of the attempts: without answer; not delivered
  std::size_t sessions = 0, same_to_the_bit = 0;
  /// Of attempts that were not delivered: ticks are missing, and the drive before them is the same.
  std::size_t same_until_lost = 0;
  std::size_t placed = 0;  ///< answered real samples: what they were is the operator's word
  /// Largest |predicted - nominal| of those delivered; of two intervals.
  std::optional<double> stretch_error;
  /// Largest |predicted - asked| of those delivered, of amplitude; |predicted - accepted| of adjustment.
  std::optional<double> ratio_error;
  /// The same of what the tray's sensor measured, of attempts that have it: printed, and no part of holds().
  std::optional<double> measured_stretch_error, measured_ratio_error;
  double ratio_tolerance = 0;
  std::vector<std::string> faults;  ///< what differs from the journal, session by session
  std::string simulated;

  bool holds() const {
    return faults.empty() && same_to_the_bit + same_until_lost == sessions &&
           stretch_error.value_or(0) <= kStretchTolerance && ratio_error.value_or(0) <= ratio_tolerance;
  }
};

/// Computes the facts of every judged attempt from its sessions, decides again, and replays each session.
/// `tell` receives 0 to 1.
Proof prove(const Run& run, const std::function<void(double)>& tell);

/// The displacement that the transducer's model predicts, or that the tray's sensor measured.
enum class Displacement { predicted, measured };

/// Of a trial of two intervals: period of the stretched stimulus over that of the standard, minus 1; none: a
/// period is unknown.
std::optional<double> stretch_by(Displacement which, const Attempt& attempt);

/// Of a trial of amplitude or adjustment: the gain by the displacement, over that of the protocol; none:
/// unknown.
std::optional<double> ratio_by(Displacement which, const Run& run, const Attempt& attempt);

/// Of an adjustment: the last gain of its session, over that of the protocol; none: unknown.
std::optional<double> accepted_ratio(const Attempt& attempt);

/// From -3 to 3. Precondition: an answer in the task amplitude.
int rating_of(const Attempt& attempt);

/// The observer of the run and what it got; empty: a person answered.
std::string observer_in_words(const Run& run);

/// STUDY-P07.trials.tsv: a row for each attempt that is no practice. Its columns are those of the task.
std::string trials_table(const Run& run);

}  // namespace tacto::analysis
