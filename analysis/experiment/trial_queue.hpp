// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a run: a function of the entries of its journal, while it runs and when it is resumed.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/trial_order.hpp"
#include "data-schema/experiment/journal.hpp"

namespace tacto::analysis {

struct Attempt {
  schema::AttemptBegun begun;
  StudyTrial trial;
  std::optional<schema::DeliveryJudged> judged;
  std::optional<schema::SamplePlaced> placed;
  std::optional<schema::AttemptAnswered> answered;

  /// Delivered, or placed as a real sample; and answered.
  bool counts() const { return answered && (placed || (judged && judged->delivered)); }
};

/// Trials in order, without the rest of a block whose time is over; one that was not delivered, or has no
/// answer because the run was interrupted, comes again at the end of its block, up to `most_attempts` times
/// in all.
class TrialQueue {
 public:
  TrialQueue(std::vector<StudyTrial> order, int most_attempts);

  /// Takes the next entry of the journal. Errors: unsuitable, if it does not follow from those before.
  schema::Result<void> take(const schema::JournalEntry& entry);

  /// The trial whose turn it is; none: all are done.
  std::optional<StudyTrial> next() const;
  /// Whether an attempt has no answer yet.
  bool is_open() const { return open_; }
  bool has_ended() const { return ended_; }
  const std::vector<Attempt>& attempts() const { return attempts_; }
  std::size_t trials() const { return trials_; }
  std::size_t counted() const;
  std::size_t answers() const;
  /// Attempts with a real sample in place.
  std::size_t placed() const;

 private:
  schema::Result<void> begin(const schema::AttemptBegun& begun);
  schema::Result<Attempt*> open_attempt(int number);
  void close();
  schema::Result<void> end_block(int block);

  std::deque<StudyTrial> queue_;
  std::map<std::string, int> tried_;  // of this block
  std::vector<Attempt> attempts_;
  std::size_t trials_;
  int most_attempts_;
  bool open_ = false, ended_ = false;
};

}  // namespace tacto::analysis
