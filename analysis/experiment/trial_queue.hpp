// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a run: a function of the entries of its journal, while it runs and when it is resumed.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/trial_order.hpp"
#include "data-schema/experiment/journal.hpp"

namespace tacto::analysis {

struct Attempt {
  schema::AttemptBegun begun;  ///< of ordering: with what was explored since
  StudyTrial trial;
  std::optional<schema::DeliveryJudged> judged;
  std::optional<schema::SamplePlaced> placed;
  std::optional<schema::AttemptAnswered> answered;

  /// No practice; delivered, or a real sample of an identification that was placed; and answered.
  bool counts() const {
    return !trial.is_practice() && answered &&
           (trial.real ? placed.has_value() : judged && judged->delivered);
  }
};

/// The codes of an order, from the word of its answer.
std::vector<std::string> codes_in(const std::string& word);

/// Trials in order, without the rest of a block whose time is over. One that has no answer because the run
/// was interrupted comes again at once, as often as that happens: so a file of answers fits as it did before.
/// One that was answered but not delivered comes again at the end of its block. After `most_attempts`
/// attempts that were judged not delivered a trial is abandoned. A practice trial that was answered comes no
/// more.
class TrialQueue {
 public:
  /// Of an adaptive method: the code of the next trial, from all attempts.
  using ChooseCode = std::function<std::string(const std::vector<Attempt>&)>;
  TrialQueue(std::vector<StudyTrial> order, int most_attempts, ChooseCode choose = {});

  /// Takes the next entry of the journal. Errors: unsuitable, if it does not follow from those before.
  schema::Result<void> take(const schema::JournalEntry& entry);

  /// The trial whose turn it is; none: all are done.
  std::optional<StudyTrial> next() const;
  /// Whether an attempt has no answer yet.
  bool is_open() const { return open_; }
  bool has_ended() const { return ended_; }
  const std::vector<Attempt>& attempts() const { return attempts_; }
  std::size_t trials() const { return trials_; }
  /// Attempts of these trials: without practice.
  std::size_t tried() const;
  std::size_t counted() const;
  std::size_t answers() const;
  /// Answered attempts for which a real sample was placed.
  std::size_t placed() const;
  /// The sample that was placed last, since the run was begun or resumed; empty: none.
  const std::string& sample() const { return sample_; }
  std::size_t abandoned() const { return abandoned_; }
  /// Trials left out because the time of their block was over.
  std::size_t timed_out() const { return timed_out_; }

 private:
  schema::Result<void> begin(const schema::AttemptBegun& begun);
  schema::Result<Attempt*> open_attempt(int number);
  schema::Result<void> explore(const schema::StimulusExplored& explored);
  void close();
  schema::Result<void> end_block(int block);

  std::deque<StudyTrial> queue_;
  ChooseCode choose_;
  std::map<std::string, int> failed_;  // attempts of each trial of this block that were not delivered
  std::vector<Attempt> attempts_;
  std::size_t trials_, abandoned_ = 0, timed_out_ = 0;
  int most_attempts_;
  std::string sample_;
  bool open_ = false, ended_ = false;
};

}  // namespace tacto::analysis
