// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the trials that are left, and writes each step before the next one.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "analysis/experiment/trial_queue.hpp"

namespace tacto::analysis {

/// What a run needs from outside.
struct TrialSteps {
  /// Returns when the entry is on the disk.
  std::function<schema::Result<void>(const schema::JournalEntry&)> keep;
  /// The attempt that begins now, for the journal.
  std::function<schema::AttemptBegun(const StudyTrial&, int attempt)> begin;
  /// Plays the intervals, and decides whether they were delivered; or has a real sample placed. None: the
  /// participant or a signal ends the run.
  std::function<schema::Result<std::optional<schema::JournalEntry>>(const Attempt&)> present;
  /// The answer, also to what was not delivered. None: as above.
  std::function<schema::Result<std::optional<schema::AttemptAnswered>>(const Attempt&)> answer;
  /// A break, if one is due before the trial; kept and taken by this. False: the run is ended.
  std::function<schema::Result<bool>()> rest;
  /// Whether the time of the trial's block is over before it begins.
  std::function<bool(const StudyTrial&)> is_over;
};

/// Until all trials are done (then the last entry is `end`) or the run is ended. Each entry is kept, then
/// taken by the queue, which is the code that resumes a journal. Errors: those of the steps.
schema::Result<void> run_trials(TrialQueue& queue, const TrialSteps& steps);

/// The queue of a run that begins.
TrialQueue queue_of_run(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                        const std::string& participant, int order);

/// The queue of a journal. Errors: unsuitable: an entry that does not follow.
schema::Result<TrialQueue> queue_of(const schema::Journal& journal, const schema::Protocol& protocol,
                                    const schema::ProtocolKey& key);

}  // namespace tacto::analysis
