// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/trial_runner.hpp"

#include "analysis/experiment/adaptive_levels.hpp"
#include "data-schema/base/creation_time.hpp"

namespace tacto::analysis {

using schema::Result;

namespace {

Result<void> keep_and_take(TrialQueue& queue, const TrialSteps& steps, const schema::JournalEntry& entry) {
  TACTO_TRY(steps.keep(entry));
  return queue.take(entry);
}

// False: the run is ended.
Result<bool> run_trial(TrialQueue& queue, const TrialSteps& steps, const StudyTrial& trial) {
  const int number = static_cast<int>(queue.attempts().size()) + 1;
  TACTO_TRY(keep_and_take(queue, steps, steps.begin(trial, number)));
  const auto presented = steps.present(queue.attempts().back());
  TACTO_TRY(presented);
  if (!*presented) return false;
  TACTO_TRY(keep_and_take(queue, steps, **presented));
  const auto answered = steps.answer(queue.attempts().back());
  TACTO_TRY(answered);
  if (!*answered) return false;
  TACTO_TRY(keep_and_take(queue, steps, **answered));
  return true;
}

}  // namespace

Result<void> run_trials(TrialQueue& queue, const TrialSteps& steps) {
  while (const auto trial = queue.next()) {
    if (steps.is_over(*trial)) {
      TACTO_TRY(keep_and_take(queue, steps, schema::BlockOver{trial->block}));
      continue;
    }
    const auto rested = steps.rest();
    TACTO_TRY(rested);
    if (!*rested) return {};
    const auto goes_on = run_trial(queue, steps, *trial);
    TACTO_TRY(goes_on);
    if (!*goes_on) return {};
  }
  return keep_and_take(queue, steps, schema::RunEnded{schema::creation_time()});
}

TrialQueue queue_of_run(const schema::Protocol& protocol, const schema::ProtocolKey& key,
                        const std::string& participant, int order) {
  // Copies: the queue may outlive both.
  const auto choose = [protocol, key](const std::vector<Attempt>& attempts) {
    return adaptive_code(protocol, key, attempts);
  };
  std::vector<StudyTrial> trials = ordered_trials(protocol, key, participant, order);
  const std::vector<StudyTrial> practice = practice_trials(trials, protocol.practice);
  trials.insert(trials.begin(), practice.begin(), practice.end());
  return TrialQueue(std::move(trials), protocol.most_attempts, choose);
}

Result<TrialQueue> queue_of(const schema::Journal& journal, const schema::Protocol& protocol,
                            const schema::ProtocolKey& key) {
  TrialQueue queue = queue_of_run(protocol, key, journal.plan.participant, journal.plan.order);
  for (const schema::JournalEntry& entry : journal.entries) TACTO_TRY(queue.take(entry));
  return queue;
}

}  // namespace tacto::analysis
