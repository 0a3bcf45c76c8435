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
  /// Plays both intervals, and decides whether they were delivered. None: the participant or a signal ends
  /// the run.
  std::function<schema::Result<std::optional<schema::DeliveryJudged>>(const Attempt&)> play;
  /// The answer, also to what was not delivered. None: as above.
  std::function<schema::Result<std::optional<schema::AttemptAnswered>>(const Attempt&)> answer;
};

/// Until all trials are done (then the last entry is `end`) or the run is ended. Each entry is kept, then
/// taken by the queue, which is the code that resumes a journal. Errors: those of the steps.
schema::Result<void> run_trials(TrialQueue& queue, const TrialSteps& steps);

/// The queue of a journal. Errors: unsuitable: an entry that does not follow.
schema::Result<TrialQueue> queue_of(const schema::Journal& journal, const schema::Protocol& protocol,
                                    const schema::ProtocolKey& key);

}  // namespace tacto::analysis
