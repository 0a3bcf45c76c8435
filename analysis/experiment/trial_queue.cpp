// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/trial_queue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace tacto::analysis {

using schema::ErrorKind;
using schema::Result;

namespace {

tl::unexpected<schema::Error> does_not_follow(const std::string& what) {
  return schema::fail(ErrorKind::unsuitable, what + " does not follow from the entries before it", {},
                      "the protocol, the key or the journal was changed");
}

// Of an ordering: the word has each of its codes once.
bool is_order_of(const std::string& word, const StudyTrial& trial) {
  if (trial.arranged.empty()) return true;
  return std::ranges::is_permutation(codes_in(word), trial.arranged);
}

}  // namespace

std::vector<std::string> codes_in(const std::string& word) {
  std::vector<std::string> codes;
  std::istringstream text(word);
  for (std::string code; text >> code;) codes.push_back(code);
  return codes;
}

TrialQueue::TrialQueue(std::vector<StudyTrial> order, int most_attempts, ChooseCode choose)
    : queue_(order.begin(), order.end()),
      choose_(std::move(choose)),
      trials_(order.size() -
              static_cast<std::size_t>(std::ranges::count_if(order, &StudyTrial::is_practice))),
      most_attempts_(most_attempts) {}

Result<void> TrialQueue::take(const schema::JournalEntry& entry) {
  if (const auto* begun = std::get_if<schema::AttemptBegun>(&entry)) return begin(*begun);
  if (const auto* judged = std::get_if<schema::DeliveryJudged>(&entry)) {
    const auto attempt = open_attempt(judged->attempt);
    TACTO_TRY(attempt);
    const StudyTrial& trial = (*attempt)->trial;
    if ((*attempt)->judged || trial.real || (!trial.sample.empty() && trial.sample != sample_))
      return does_not_follow(fmt::format("attempt {}", judged->attempt));
    (*attempt)->judged = *judged;
  }
  if (const auto* placed = std::get_if<schema::SamplePlaced>(&entry)) {
    const auto attempt = open_attempt(placed->attempt);
    TACTO_TRY(attempt);
    const StudyTrial& trial = (*attempt)->trial;
    if ((*attempt)->placed || (*attempt)->judged || placed->label != (trial.real ? trial.code : trial.sample))
      return does_not_follow(fmt::format("sample {} of attempt {}", placed->label, placed->attempt));
    (*attempt)->placed = *placed;
    sample_ = placed->label;
  }
  if (const auto* explored = std::get_if<schema::StimulusExplored>(&entry)) return explore(*explored);
  if (const auto* over = std::get_if<schema::BlockOver>(&entry)) return end_block(over->block);
  if (const auto* answered = std::get_if<schema::AttemptAnswered>(&entry)) {
    const auto attempt = open_attempt(answered->attempt);
    TACTO_TRY(attempt);
    const bool presented =
        (*attempt)->trial.real ? (*attempt)->placed.has_value() : (*attempt)->judged.has_value();
    if (!presented || !is_order_of(answered->word, (*attempt)->trial))
      return does_not_follow(fmt::format("attempt {}", answered->attempt));
    (*attempt)->answered = *answered;
    close();
  }
  if (std::holds_alternative<schema::BreakTaken>(entry) && open_) return does_not_follow("a break");
  if (std::holds_alternative<schema::RunResumed>(entry)) sample_.clear();
  if (std::holds_alternative<schema::RunResumed>(entry) && open_) close();
  if (std::holds_alternative<schema::RunEnded>(entry)) ended_ = true;
  return {};
}

std::optional<StudyTrial> TrialQueue::next() const {
  if (queue_.empty()) return std::nullopt;
  StudyTrial trial = queue_.front();
  if (trial.adaptive) trial.code = choose_(attempts_);
  return trial;
}

std::size_t TrialQueue::counted() const {
  return static_cast<std::size_t>(std::ranges::count_if(attempts_, &Attempt::counts));
}

std::size_t TrialQueue::tried() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(attempts_, [](const Attempt& each) { return !each.trial.is_practice(); }));
}

std::size_t TrialQueue::placed() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(attempts_, [](const Attempt& each) { return each.placed && each.answered; }));
}

std::size_t TrialQueue::answers() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(attempts_, [](const Attempt& each) { return each.answered.has_value(); }));
}

Result<void> TrialQueue::begin(const schema::AttemptBegun& begun) {
  const int number = static_cast<int>(attempts_.size()) + 1;
  const auto trial = next();
  if (open_ || begun.attempt != number || !trial || trial->name() != begun.trial ||
      trial->block != begun.block)
    return does_not_follow(fmt::format("attempt {} at trial {}", begun.attempt, begun.trial));
  if (!attempts_.empty() && attempts_.back().trial.block != begun.block) failed_.clear();
  attempts_.push_back({begun, *trial, {}, {}, {}});
  queue_.pop_front();
  open_ = true;
  return {};
}

Result<Attempt*> TrialQueue::open_attempt(int number) {
  if (open_ && attempts_.back().begun.attempt == number) return &attempts_.back();
  return does_not_follow(fmt::format("attempt {}", number));
}

Result<void> TrialQueue::explore(const schema::StimulusExplored& explored) {
  const auto attempt = open_attempt(explored.attempt);
  TACTO_TRY(attempt);
  const auto& arranged = (*attempt)->trial.arranged;
  if ((*attempt)->judged || std::ranges::find(arranged, explored.stimulus) == arranged.end())
    return does_not_follow(fmt::format("stimulus {} of attempt {}", explored.stimulus, explored.attempt));
  (*attempt)->begun.stimuli.push_back(explored.stimulus);
  (*attempt)->begun.sessions.push_back(explored.session);
  return {};
}

void TrialQueue::close() {
  const Attempt& attempt = attempts_.back();
  open_ = false;
  const bool practice = attempt.trial.is_practice();
  if (attempt.counts() || (practice && attempt.answered)) return;
  const bool failed = !practice && attempt.judged && !attempt.judged->delivered;
  // A trial of an adaptive method comes again with another code.
  const std::string trial =
      attempt.trial.adaptive ? fmt::format("{}", attempt.trial.repetition) : attempt.begun.trial;
  if (failed && ++failed_[trial] >= most_attempts_) {
    ++abandoned_;
    return;
  }
  const auto next_block =
      std::ranges::find_if(queue_, [&](const StudyTrial& each) { return each.block > attempt.trial.block; });
  queue_.insert(attempt.answered ? next_block : queue_.begin(), attempt.trial);
}

Result<void> TrialQueue::end_block(int block) {
  if (open_ || queue_.empty() || queue_.front().block != block)
    return does_not_follow(fmt::format("the end of block {}", block));
  while (!queue_.empty() && queue_.front().block == block) queue_.pop_front(), --trials_, ++timed_out_;
  return {};
}

}  // namespace tacto::analysis
