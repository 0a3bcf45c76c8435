// SPDX-License-Identifier: GPL-3.0-or-later
// The run of an experiment without a device: order, journal cut at each byte, decisions, observer, period.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "analysis/experiment/adaptive_levels.hpp"
#include "analysis/experiment/interval_facts.hpp"
#include "analysis/experiment/interval_guide.hpp"
#include "analysis/experiment/interval_play.hpp"
#include "analysis/experiment/live_setting.hpp"
#include "analysis/experiment/observer.hpp"
#include "analysis/experiment/spatial_period.hpp"
#include "analysis/experiment/study.hpp"
#include "analysis/experiment/study_answers.hpp"
#include "analysis/experiment/template_observer.hpp"
#include "analysis/experiment/trial_runner.hpp"
#include "analysis/psychometrics/staircase.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::Result;

// Ten levels, twice each: 20 trials.
schema::Protocol twenty_trials() {
  schema::Protocol protocol = stretch_protocol("7");
  protocol.levels = {-0.5, -0.4, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4, 0.5};
  protocol.repetitions = 2;
  protocol.most_attempts = 100;
  return protocol;
}

schema::ProtocolKey key_of(const schema::Protocol& protocol) {
  return {stimuli_by_code(protocol), ""};
}

// Identification of five names: three comparisons, in a real and in a virtual block of five trials each.
schema::Protocol ten_trials() {
  schema::Protocol protocol = twenty_trials();
  protocol.task = schema::Task::identification;
  protocol.levels.clear();
  protocol.standards = {"A", "B", "C", "D", "E"}, protocol.comparisons = {"C", "D", "E"};
  protocol.conditions = {"real", "virtual"};
  protocol.most_trials = 5, protocol.longest_s = 900;
  return protocol;
}

// Three orders of four names.
schema::Protocol three_orders() {
  schema::Protocol protocol = twenty_trials();
  protocol.task = schema::Task::ordering;
  protocol.levels.clear();
  protocol.standards = {"A", "B", "C", "D"};
  protocol.repetitions = 3;
  return protocol;
}

// Three textures, each beside the sample of each: 3 blocks of 4 trials.
schema::Protocol twelve_beside_samples() {
  schema::Protocol protocol = three_orders();
  protocol.task = schema::Task::fidelity;
  protocol.standards = {"A", "B", "C"};
  protocol.repetitions = 1;
  return protocol;
}

schema::Protocol adaptive(schema::LevelMethod method) {
  schema::Protocol protocol = stretch_protocol("7", method);
  protocol.repetitions = 20;
  protocol.most_attempts = 100;
  return protocol;
}

// A run whose journal is a text: every seventh attempt is not delivered.
class TextRun {
 public:
  explicit TextRun(schema::Protocol protocol = twenty_trials()) : protocol_(std::move(protocol)) {}

  // The time of block 1 is over after so many attempts.
  int attempts_in_time = 1000;
  // Attempts before this one are interrupted while they are presented.
  int first_presented = 1;
  std::size_t trials_between_breaks = 1000;

  // Begins a run, or resumes what is whole in `journal`. Errors: of parse_journal.
  Result<void> go_on(const std::string& journal) {
    if (journal.empty()) return run_from(schema::RunPlanned{"lab", "P01", "", "", "none", "", "", "", 1});
    const auto parsed = schema::parse_journal(journal, "journal");
    if (!parsed) return schema::forward_error(parsed);
    text_ = journal.substr(0, parsed->sound_bytes);
    lines_ = parsed->entries.size();
    auto queue = queue_of(*parsed, protocol_, key_);
    if (!queue) return schema::forward_error(queue);
    queue_ = std::move(*queue);
    return queue_.has_ended() ? Result<void>() : run_from(schema::RunResumed{""});
  }

  const std::string& text() const { return text_; }
  const TrialQueue& queue() const { return queue_; }

 private:
  Result<void> keep(const schema::JournalEntry& entry) {
    text_ += schema::journal_line(entry, ++lines_);
    return {};
  }

  Result<void> run_from(const schema::JournalEntry& first) {
    if (const auto kept = keep(first); !kept) return kept;
    if (const auto taken = queue_.take(first); !taken) return taken;
    TrialSteps steps;
    steps.keep = [this](const schema::JournalEntry& entry) { return keep(entry); };
    steps.begin = [](const StudyTrial& trial, int attempt) {
      if (!trial.arranged.empty()) return schema::AttemptBegun{attempt, trial.name(), {}, {}, trial.block, 0};
      return schema::AttemptBegun{attempt, trial.name(), {"K1", trial.code}, {"a", "b"}, trial.block, 0};
    };
    steps.rest = [this]() -> Result<bool> {
      const std::size_t attempts = queue_.attempts().size();
      if (attempts == 0 || attempts % trials_between_breaks != 0) return true;
      const schema::BreakTaken taken{30};
      if (const auto kept = keep(taken); !kept) return schema::forward_error(kept);
      if (const auto done = queue_.take(taken); !done) return schema::forward_error(done);
      return true;
    };
    steps.is_over = [this](const StudyTrial& trial) {
      return trial.block == 1 && static_cast<int>(queue_.attempts().size()) >= attempts_in_time;
    };
    steps.present = [this](const Attempt& attempt) -> Result<std::optional<schema::JournalEntry>> {
      if (attempt.begun.attempt < first_presented) return std::nullopt;
      if (attempt.trial.real) return schema::SamplePlaced{attempt.begun.attempt, attempt.trial.code};
      if (const std::string& sample = attempt.trial.sample; !sample.empty() && sample != queue_.sample()) {
        const schema::SamplePlaced placed{attempt.begun.attempt, sample};
        if (const auto kept = keep(placed); !kept) return schema::forward_error(kept);
        if (const auto taken = queue_.take(placed); !taken) return schema::forward_error(taken);
      }
      for (const std::string& code : attempt.trial.arranged) {
        const schema::StimulusExplored explored{attempt.begun.attempt, code, "a"};
        if (const auto kept = keep(explored); !kept) return schema::forward_error(kept);
        if (const auto taken = queue_.take(explored); !taken) return schema::forward_error(taken);
      }
      const bool delivered = attempt.begun.attempt % 7 != 0;
      return schema::DeliveryJudged{attempt.begun.attempt, delivered, {}, {}};
    };
    steps.answer = [](const Attempt& attempt) -> Result<std::optional<schema::AttemptAnswered>> {
      if (const auto& codes = attempt.trial.arranged; !codes.empty())
        return schema::AttemptAnswered{attempt.begun.attempt, 0, fmt::format("{}", fmt::join(codes, " ")), 0};
      return schema::AttemptAnswered{attempt.begun.attempt, 1 + attempt.begun.attempt % 2, "word", 0};
    };
    return run_trials(queue_, steps);
  }

  const schema::Protocol protocol_;
  const schema::ProtocolKey key_ = key_of(protocol_);
  TrialQueue queue_ = queue_of_run(protocol_, key_, "P01", 1);
  std::string text_;
  std::size_t lines_ = 0;
};

std::map<std::string, int> counted_trials(const TrialQueue& queue) {
  std::map<std::string, int> counted;
  for (const Attempt& attempt : queue.attempts())
    if (attempt.counts()) ++counted[std::to_string(attempt.trial.block) + "/" + attempt.begun.trial];
  return counted;
}

std::size_t lines_with(const std::string& text, const std::string& word) {
  std::size_t lines = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++lines;
  return lines;
}

TEST(ExperimentRun, WhatIsNotDeliveredComesAgainAtTheEnd) {
  TextRun run;
  ASSERT_TRUE(run.go_on(""));
  EXPECT_TRUE(run.queue().has_ended());
  const auto& attempts = run.queue().attempts();
  ASSERT_EQ(attempts.size(), 23u);  // 7, 14 and 21 fail
  EXPECT_EQ(attempts[20].begun.trial, attempts[6].begun.trial);
  EXPECT_EQ(attempts[21].begun.trial, attempts[13].begun.trial);
  EXPECT_EQ(attempts[22].begun.trial, attempts[6].begun.trial);
  EXPECT_EQ(counted_trials(run.queue()).size(), 20u);
  EXPECT_EQ(run.queue().answers(), 23u);
}

// Wherever the journal ends: it is resumed, all whole lines stay, and each trial counts once.
TEST(ExperimentRun, AJournalCutAtEachByteIsResumedWithEachAnswerOnce) {
  TextRun whole;
  whole.trials_between_breaks = 5;
  ASSERT_TRUE(whole.go_on(""));
  const std::string& text = whole.text();
  ASSERT_EQ(lines_with(text, R"("event":"break")"), 4u);
  const std::size_t first_line = text.find('\n') + 1;
  for (std::size_t bytes = 1; bytes <= text.size(); ++bytes) {
    const std::string cut = text.substr(0, bytes);
    TextRun resumed;
    const auto went_on = resumed.go_on(cut);
    if (bytes < first_line) {
      ASSERT_FALSE(went_on) << bytes;
      ASSERT_EQ(went_on.error().kind, ErrorKind::unsuitable) << bytes;
      continue;
    }
    ASSERT_TRUE(went_on) << bytes << ": " << schema::message(went_on.error());
    const std::size_t whole_lines = cut.rfind('\n') + 1;
    ASSERT_EQ(resumed.text().substr(0, whole_lines), text.substr(0, whole_lines)) << bytes;
    ASSERT_TRUE(resumed.queue().has_ended()) << bytes;
    const auto counted = counted_trials(resumed.queue());
    ASSERT_EQ(counted.size(), 20u) << bytes;
    for (const auto& [trial, times] : counted) ASSERT_EQ(times, 1) << bytes << " " << trial;
    ASSERT_EQ(resumed.queue().answers(), lines_with(resumed.text(), R"("event":"answered")")) << bytes;
  }
}

// Practice trials are the last ones of the first block. They come once, and count nowhere; an interrupted one
// comes again.
TEST(ExperimentRun, PracticeComesFirstAndCountsNowhere) {
  for (schema::Protocol protocol : {twenty_trials(), ten_trials(), three_orders(), twelve_beside_samples(),
                                    adaptive(schema::LevelMethod::staircase)}) {
    const auto trials = ordered_trials(protocol, key_of(protocol), "P01", 1);
    const std::size_t own = trials.size();
    protocol.practice = 2;
    TextRun whole(protocol);
    ASSERT_TRUE(whole.go_on(""));
    const std::string& text = whole.text();
    const auto& attempts = whole.queue().attempts();
    ASSERT_TRUE(whole.queue().has_ended());
    EXPECT_EQ(whole.queue().trials(), own);
    EXPECT_EQ(whole.queue().counted(), own);
    EXPECT_EQ(whole.queue().tried() + 2, attempts.size());
    EXPECT_EQ(whole.queue().abandoned(), 0U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(attempts[i].trial.is_practice(), i < 2);
    const auto block =
        static_cast<std::size_t>(std::ranges::count(trials, trials.front().block, &StudyTrial::block));
    for (std::size_t i = 0; i < 2 && !trials.front().adaptive; ++i)
      EXPECT_EQ(attempts[i].begun.trial, trials[block - 2 + i].name());
    for (std::size_t bytes = text.find('\n') + 1; bytes <= text.size(); bytes += 7) {
      TextRun resumed(protocol);
      const auto went_on = resumed.go_on(text.substr(0, bytes));
      ASSERT_TRUE(went_on) << bytes << ": " << schema::message(went_on.error());
      ASSERT_EQ(resumed.queue().counted(), own) << bytes;
      ASSERT_EQ(resumed.queue().attempts().size() - resumed.queue().tried(),
                static_cast<std::size_t>(std::ranges::count_if(
                    resumed.queue().attempts(), [](const Attempt& each) { return each.begun.block == 0; })));
    }
  }
}

// The same with two blocks: real samples, then playback, of which what was not delivered comes again.
TEST(ExperimentRun, AJournalOfTwoBlocksCutAtEachByteIsResumed) {
  for (const int in_time : {1000, 3}) {
    TextRun whole(ten_trials());
    whole.attempts_in_time = in_time;
    ASSERT_TRUE(whole.go_on(""));
    const std::string& text = whole.text();
    const std::size_t trials = in_time == 3 ? 8 : 10;
    ASSERT_EQ(whole.queue().trials(), trials);
    ASSERT_EQ(whole.queue().counted(), trials);
    ASSERT_EQ(whole.queue().timed_out(), 10 - trials);
    ASSERT_EQ(whole.queue().abandoned(), 0u);
    ASSERT_EQ(whole.queue().placed(), trials - 5);
    ASSERT_EQ(whole.queue().attempts().size(), trials + 1);  // attempt 7 is played, and not delivered
    ASSERT_EQ(lines_with(text, R"("event":"block_over")"), in_time == 3 ? 1u : 0u);
    for (std::size_t bytes = text.find('\n') + 1; bytes <= text.size(); ++bytes) {
      TextRun resumed(ten_trials());
      resumed.attempts_in_time = in_time;
      const auto went_on = resumed.go_on(text.substr(0, bytes));
      ASSERT_TRUE(went_on) << bytes << ": " << schema::message(went_on.error());
      const std::size_t whole_lines = text.rfind('\n', bytes - 1) + 1;
      ASSERT_EQ(resumed.text().substr(0, whole_lines), text.substr(0, whole_lines)) << bytes;
      ASSERT_TRUE(resumed.queue().has_ended()) << bytes;
      const auto counted = counted_trials(resumed.queue());
      // An interrupted real sample comes again, and then the time may be over.
      ASSERT_LE(counted.size(), trials) << bytes;
      ASSERT_GE(counted.size(), in_time == 3 ? trials - 1 : trials) << bytes;
      for (const auto& [trial, times] : counted) ASSERT_EQ(times, 1) << bytes << " " << trial;
    }
  }
}

// Only what was judged not delivered uses up an attempt, and an interrupted trial is the next one again.
TEST(ExperimentRun, InterruptionsUseUpNoAttempt) {
  for (const int interrupted : {0, 5}) {
    schema::Protocol protocol = ten_trials();
    protocol.most_attempts = 1;
    TextRun run(protocol);
    run.first_presented = interrupted + 1;
    for (int i = 0; i <= interrupted; ++i) {
      ASSERT_FALSE(run.queue().has_ended());
      const auto went_on = run.go_on(std::string(run.text()));
      ASSERT_TRUE(went_on) << schema::message(went_on.error());
    }
    ASSERT_TRUE(run.queue().has_ended());
    const auto& attempts = run.queue().attempts();
    ASSERT_EQ(attempts.size(), 10u + static_cast<std::size_t>(interrupted));
    for (std::size_t i = 0; i < static_cast<std::size_t>(interrupted); ++i)
      EXPECT_EQ(attempts[i].begun.trial, attempts[5].begun.trial);
    // One attempt is played and not delivered: 7, or 14 after the interruptions.
    EXPECT_EQ(run.queue().abandoned(), 1u);
    EXPECT_EQ(run.queue().counted(), 9u);
    EXPECT_EQ(run.queue().placed(), 5u);
    EXPECT_EQ(run.queue().timed_out(), 0u);
  }
}

TEST(ExperimentRun, BlocksAreOrderedByAWilliamsSquare) {
  for (std::size_t count = 1; count <= 7; ++count) {
    std::map<std::pair<std::size_t, std::size_t>, int> at_place, after;
    for (int row = 1; row <= williams_rows(count); ++row) {
      const std::vector<std::size_t> order = williams_row(count, row);
      ASSERT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), count) << count << " " << row;
      for (std::size_t i = 0; i < count; ++i) {
        ++at_place[{i, order[i]}];
        if (i > 0) ++after[{order[i - 1], order[i]}];
      }
    }
    const int times = count % 2 == 0 ? 1 : 2;
    ASSERT_EQ(at_place.size(), count * count);
    ASSERT_EQ(after.size(), count * (count - 1));
    for (const auto& [place, number] : at_place) EXPECT_EQ(number, times) << count;
    for (const auto& [pair, number] : after) EXPECT_EQ(number, times) << count;
  }
  const schema::Protocol protocol = ten_trials();
  for (const int row : {1, 2}) {
    const auto trials = ordered_trials(protocol, key_of(protocol), "P01", row);
    ASSERT_EQ(trials.size(), 10u);
    EXPECT_EQ(trials.front().real, row == 1);
    EXPECT_EQ(trials.back().real, row == 2);
  }
}

// Three sinusoids of 10 um, an octave apart: the RMS is in the band of each, to the window's resolution, and
// the levels do not depend on speed along the path. The other bands have the floor of 0.1 um, -20 dB, or the
// skirt of the window below it.
TEST(ExperimentRun, BandLevelsAreThoseOfASinusoidAtUnevenSpeed) {
  for (const double frequency_per_m : {500.0, 1000.0, 2000.0}) {
    std::vector<double> position_m, displacement_m;
    for (int i = 0; i <= 2000; ++i) {
      const double part = i / 2000.0;
      position_m.push_back(0.002 + 0.04 * (part - std::sin(2 * std::numbers::pi * part) / 8));
      displacement_m.push_back(1e-5 *
                               std::sin(2 * std::numbers::pi * (frequency_per_m * position_m.back() + 0.1)));
    }
    const auto levels_db = band_levels_db(position_m, displacement_m, 0.05);
    ASSERT_EQ(levels_db.size(), 15u);  // third octaves from 0.3 /mm to 9.6 /mm
    double square = 0;
    for (const double level_db : levels_db) square += std::pow(10, level_db / 10);
    EXPECT_NEAR(square - 15 * 0.01, 50, 0.5) << frequency_per_m;  // 7.07 um
    const auto largest = std::ranges::max_element(levels_db) - levels_db.begin();
    EXPECT_EQ(largest, std::floor(3 * std::log2(frequency_per_m / 300))) << frequency_per_m;
  }
}

// An ordering explores its stimuli one by one: each is a line. The journal is cut at each byte.
TEST(ExperimentRun, AJournalOfOrdersCutAtEachByteIsResumed) {
  TextRun whole(three_orders());
  ASSERT_TRUE(whole.go_on(""));
  const std::string& text = whole.text();
  ASSERT_EQ(whole.queue().attempts().size(), 3U);
  for (const Attempt& attempt : whole.queue().attempts()) {
    EXPECT_EQ(attempt.begun.stimuli, attempt.trial.arranged);
    EXPECT_EQ(std::set<std::string>(attempt.trial.arranged.begin(), attempt.trial.arranged.end()).size(), 4U);
  }
  for (std::size_t bytes = text.find('\n') + 1; bytes <= text.size(); ++bytes) {
    TextRun resumed(three_orders());
    const auto went_on = resumed.go_on(text.substr(0, bytes));
    ASSERT_TRUE(went_on) << bytes << ": " << schema::message(went_on.error());
    ASSERT_TRUE(resumed.queue().has_ended()) << bytes;
    const auto counted = counted_trials(resumed.queue());
    ASSERT_EQ(counted.size(), 3U) << bytes;
    for (const auto& [trial, times] : counted) ASSERT_EQ(times, 1) << bytes << " " << trial;
  }
}

// A sample stays for its block, and is placed again after an interruption. The journal is cut at each byte.
TEST(ExperimentRun, AJournalOfSamplesBesideTexturesCutAtEachByteIsResumed) {
  TextRun whole(twelve_beside_samples());
  ASSERT_TRUE(whole.go_on(""));
  const std::string& text = whole.text();
  ASSERT_EQ(whole.queue().counted(), 12U);
  ASSERT_EQ(lines_with(text, R"("event":"placed")"), 3U);
  int own = 0;
  for (const Attempt& attempt : whole.queue().attempts())
    own += attempt.counts() && attempt.trial.code == attempt.trial.sample;
  EXPECT_EQ(own, 6);
  for (std::size_t bytes = text.find('\n') + 1; bytes <= text.size(); ++bytes) {
    TextRun resumed(twelve_beside_samples());
    const auto went_on = resumed.go_on(text.substr(0, bytes));
    ASSERT_TRUE(went_on) << bytes << ": " << schema::message(went_on.error());
    ASSERT_TRUE(resumed.queue().has_ended()) << bytes;
    const auto counted = counted_trials(resumed.queue());
    ASSERT_EQ(counted.size(), 12U) << bytes;
    for (const auto& [trial, times] : counted) ASSERT_EQ(times, 1) << bytes << " " << trial;
  }
}

TEST(ExperimentRun, ATextureBesideNoSampleOrAnotherOneIsRefused) {
  const schema::Protocol protocol = twelve_beside_samples();
  const StudyTrial trial = ordered_trials(protocol, key_of(protocol), "P01", 1).front();
  TrialQueue queue({trial}, 3);
  ASSERT_TRUE(queue.take(schema::AttemptBegun{1, trial.name(), {}, {}, 1, 0}));
  EXPECT_FALSE(queue.take(schema::DeliveryJudged{1, true, {}, {}}));
  EXPECT_FALSE(queue.take(schema::SamplePlaced{1, "K9"}));
  ASSERT_TRUE(queue.take(schema::SamplePlaced{1, trial.sample}));
  EXPECT_FALSE(queue.take(schema::AttemptAnswered{1, 1, "same", 0}));
  ASSERT_TRUE(queue.take(schema::DeliveryJudged{1, true, {}, {}}));
  ASSERT_TRUE(queue.take(schema::AttemptAnswered{1, 1, "same", 0}));
  EXPECT_TRUE(queue.attempts().front().counts());
}

std::vector<double> stretches_of(const TrialQueue& queue, const schema::ProtocolKey& key, bool counted) {
  std::vector<double> stretches;
  for (const Attempt& attempt : queue.attempts())
    if (!counted || attempt.counts()) stretches.push_back(stimulus_of(key, attempt.trial.code).stretch);
  return stretches;
}

// An adaptive run is resumed with the same levels: they follow from the answers of the journal. (Interrupted
// attempts are numbered, and every seventh fails, so only the levels that count are compared until the cut.)
TEST(ExperimentRun, AnAdaptiveJournalCutAtEachLineGoesOnWithTheSameLevels) {
  for (const auto method : {schema::LevelMethod::staircase, schema::LevelMethod::quest_plus}) {
    const schema::Protocol protocol = adaptive(method);
    TextRun whole(protocol);
    ASSERT_TRUE(whole.go_on(""));
    ASSERT_EQ(whole.queue().counted(), 20U);
    ASSERT_EQ(whole.queue().attempts().size(), 23U);
    const std::string& text = whole.text();
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', end + 1)) {
      TextRun resumed(protocol);
      const auto went_on = resumed.go_on(text.substr(0, end + 1));
      ASSERT_TRUE(went_on) << end << ": " << schema::message(went_on.error());
      ASSERT_EQ(resumed.text().substr(0, end + 1), text.substr(0, end + 1)) << end;
      ASSERT_TRUE(resumed.queue().has_ended()) << end;
      ASSERT_EQ(resumed.queue().counted(), 20U) << end;
      std::set<int> repetitions;
      for (const Attempt& attempt : resumed.queue().attempts())
        if (attempt.counts()) repetitions.insert(attempt.trial.repetition);
      ASSERT_EQ(repetitions.size(), 20U) << end;
    }
  }
}

// Against the staircase and QUEST+ themselves, which get the counted answers only: attempts 7, 14 and 21
// fail.
TEST(ExperimentRun, AdaptiveLevelsFollowFromTheAnswersThatCount) {
  const schema::Protocol protocol = adaptive(schema::LevelMethod::staircase);
  const schema::ProtocolKey key = key_of(protocol);
  TextRun run(protocol);
  ASSERT_TRUE(run.go_on(""));
  Staircase staircase({2, 1, 0.05, 0.05, 0.05, 0.7}, 0.7);
  std::size_t failed = 0;
  for (const Attempt& attempt : run.queue().attempts()) {
    EXPECT_NEAR(stimulus_of(key, attempt.trial.code).stretch, staircase.level(), 1e-9)
        << attempt.begun.attempt;
    if (attempt.counts()) staircase.take_answer(seemed_longer(attempt));
    failed += !attempt.counts();
  }
  EXPECT_EQ(failed, 3U);
  EXPECT_GT(staircase.reversals().size(), 0U);
  const auto reversals = reversals_of(protocol, key, run.queue().attempts());
  ASSERT_EQ(reversals.size(), staircase.reversals().size());
  for (std::size_t i = 0; i < reversals.size(); ++i)
    EXPECT_NEAR(reversals[i], staircase.reversals()[i], 1e-9);
}

// An observer with a JND of 25 %: QUEST+ asks near its steep part, not at the smallest and largest stretches
// only.
TEST(ExperimentRun, QuestPlusAsksWhereTheAnswersSayMost) {
  const schema::Protocol protocol = adaptive(schema::LevelMethod::quest_plus);
  const schema::ProtocolKey key = key_of(protocol);
  TrialQueue queue = queue_of_run(protocol, key, "P01", 1);
  const auto observer = parse_observer("weber=25%,seed=3");
  ASSERT_TRUE(observer);
  double squares = 0;
  for (int number = 1; number <= 20; ++number) {
    const StudyTrial trial = queue.next().value();
    ASSERT_TRUE(queue.take(schema::AttemptBegun{number, trial.name(), {}, {}, 1, 0}));
    ASSERT_TRUE(queue.take(schema::DeliveryJudged{number, true, {}, {}}));
    const double standard = 2e-3, stretched = standard * (1 + stimulus_of(key, trial.code).stretch);
    const bool first = trial.standard_comes_first();
    const int choice = smaller_period(*observer, "P/" + std::to_string(number),
                                      {first ? standard : stretched, first ? stretched : standard}, standard);
    ASSERT_TRUE(queue.take(schema::AttemptAnswered{number, choice, "word", 0}));
  }
  const auto stretches = stretches_of(queue, key, true);
  for (const double stretch : stretches) squares += stretch * stretch / 20;
  EXPECT_TRUE(0.15 < std::sqrt(squares) && std::sqrt(squares) < 0.6) << std::sqrt(squares);
  EXPECT_TRUE(std::ranges::min(stretches) < 0 && std::ranges::max(stretches) > 0);
}

// A trial that is never delivered is abandoned, also if its level changes in between.
TEST(ExperimentRun, AnAdaptiveTrialIsAbandonedByItsNumber) {
  schema::Protocol protocol = adaptive(schema::LevelMethod::quest_plus);
  protocol.most_attempts = 1;
  TextRun run(protocol);
  ASSERT_TRUE(run.go_on(""));
  EXPECT_EQ(run.queue().attempts().size(), 20U);
  EXPECT_EQ(run.queue().abandoned(), 2U);
  EXPECT_EQ(run.queue().counted(), 18U);
}

TEST(ExperimentRun, AnOrderThatIsNoneIsRefused) {
  const schema::Protocol protocol = three_orders();
  const StudyTrial trial = ordered_trials(protocol, key_of(protocol), "P01", 1).front();
  for (const auto& [word, is_order] : {std::pair{"K1 K2 K3 K4", true},
                                       {"K4 K2 K3 K1", true},
                                       {"K1 K2 K3", false},
                                       {"K1 K2 K3 K3", false},
                                       {"K1 K2 K3 K5", false},
                                       {"", false}}) {
    TrialQueue queue({trial}, 3);
    ASSERT_TRUE(queue.take(schema::AttemptBegun{1, trial.name(), {}, {}, 1, 0}));
    EXPECT_FALSE(queue.take(schema::StimulusExplored{1, "K5", "s"}));
    EXPECT_FALSE(queue.take(schema::StimulusExplored{2, "K1", "s"}));
    ASSERT_TRUE(queue.take(schema::StimulusExplored{1, "K1", "s"}));
    ASSERT_TRUE(queue.take(schema::DeliveryJudged{1, true, {}, {}}));
    EXPECT_FALSE(queue.take(schema::StimulusExplored{1, "K1", "s"}));
    EXPECT_EQ(queue.take(schema::AttemptAnswered{1, 0, word, 0}).has_value(), is_order) << word;
  }
}

// The start of a series is in the outer quarter of the range; a step leads to the nearest setting in the
// range.
TEST(ExperimentRun, SettingsStartAtTheEndsAndStayInTheRange) {
  schema::Protocol protocol = three_orders();
  protocol.task = schema::Task::adjustment;
  protocol.standards = {"A"};
  protocol.repetitions = 50;
  protocol.smallest_ratio = 0.05, protocol.largest_ratio = 4, protocol.step_db = 2;
  const double quarter = std::pow(80, 0.25);
  for (const StudyTrial& trial : ordered_trials(protocol, key_of(protocol), "P01", 1)) {
    EXPECT_EQ(trial.is_ascending(), trial.repetition % 2 == 1);
    EXPECT_GE(trial.ratio, trial.is_ascending() ? 0.05 : 4 / quarter);
    EXPECT_LE(trial.ratio, trial.is_ascending() ? 0.05 * quarter : 4);
    for (const double wanted : {0.01, 0.3, 20.0}) {
      double ratio = trial.ratio;
      int steps = 0;
      for (; steps < 100; ++steps) {
        const schema::Turn turn = turn_towards(protocol, ratio, ratio, wanted);
        if (turn == schema::Turn::accept) break;
        ratio = stepped(protocol, ratio, turn);
      }
      EXPECT_LT(steps, 40);
      EXPECT_TRUE(0.05 <= ratio && ratio <= 4) << ratio;
      const double nearest = std::clamp(wanted, 0.05, 4.0);
      EXPECT_LE(std::abs(20 * std::log10(ratio / nearest)), wanted == 0.3 ? 1.001 : 2) << wanted;
    }
  }
}

// Means of 4000 draws: the tolerance is four standard errors of 10 %.
TEST(ExperimentRun, TheCriterionOfAnAdjustmentHasItsSpreadAndHysteresis) {
  const auto observer = parse_observer("threshold=20%,sd=10%,hysteresis=21%,seed=2");
  ASSERT_TRUE(observer);
  double sums[2] = {0, 0}, squares = 0;
  for (int i = 0; i < 4000; ++i)
    for (const bool ascending : {false, true}) {
      const double level = std::log(criterion_of(*observer, "P/" + std::to_string(i), ascending) / 0.2);
      sums[ascending] += level / 4000;
      if (ascending) squares += std::pow(level + std::log(1.21) / 2, 2) / 4000;
    }
  EXPECT_NEAR(sums[false], std::log(1.21) / 2, 0.0064);
  EXPECT_NEAR(sums[true], -std::log(1.21) / 2, 0.0064);
  EXPECT_NEAR(std::sqrt(squares), 0.1, 0.0046);
}

TEST(ExperimentRun, AChangedLineInTheMiddleIsRefusedWithItsNumber) {
  TextRun whole;
  ASSERT_TRUE(whole.go_on(""));
  const std::string& text = whole.text();
  const auto second = text.find('\n') + 1, third = text.find('\n', second) + 1;
  std::string changed = text;
  changed[text.find("K", second)] = 'L';
  const auto refused = schema::parse_journal(changed, "j");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::malformed);
  EXPECT_EQ(refused.error().where, "j: line 2");
  const auto missing = schema::parse_journal(text.substr(0, second) + text.substr(third), "j");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().where, "j: line 2");
  changed = text.substr(0, text.size() - 3) + "x\"}\n";  // the last line: not written completely
  const auto last = schema::parse_journal(changed, "j");
  ASSERT_TRUE(last);
  EXPECT_EQ(last->entries.size(), lines_with(text, "\n") - 1);
}

TEST(ExperimentRun, ABreakIsBetweenTrials) {
  const schema::Protocol protocol = twenty_trials();
  TrialQueue queue = queue_of_run(protocol, key_of(protocol), "P01", 1);
  const StudyTrial trial = queue.next().value();
  ASSERT_TRUE(queue.take(schema::BreakTaken{1}));
  ASSERT_TRUE(queue.take(schema::AttemptBegun{1, trial.name(), {}, {}, 1, 0}));
  EXPECT_FALSE(queue.take(schema::BreakTaken{1}));
}

TEST(ExperimentRun, AnEntryThatDoesNotFollowIsRefused) {
  TextRun whole;
  ASSERT_TRUE(whole.go_on(""));
  auto journal = schema::parse_journal(whole.text(), "j").value();
  schema::Protocol other = twenty_trials();
  other.seed = "8";
  const auto queue = queue_of(journal, other, key_of(other));
  ASSERT_FALSE(queue);
  EXPECT_EQ(queue.error().kind, ErrorKind::unsuitable);
}

TEST(ExperimentRun, HalfOfTheTrialsBeginWithTheStandard) {
  const schema::Protocol protocol = stretch_protocol("1");
  const auto trials = ordered_trials(protocol, key_of(protocol), "P01", 1);
  EXPECT_EQ(trials.size(), 80u);
  std::map<std::string, int> first;
  std::set<std::string> names;
  for (const StudyTrial& trial : trials) {
    first[trial.code] += trial.standard_comes_first();
    names.insert(trial.name());
  }
  EXPECT_EQ(names.size(), 80u);
  for (const auto& [code, times] : first) EXPECT_EQ(times, 5) << code;
}

// The cue is where an emulated finger is, which follows the path by its knots, forth and back if it has an
// odd number of strokes. Between two knots, 5 ms, the way bends by at most a t^2 / 8 = 4 um of 1.2 m/s^2.
TEST(ExperimentRun, TheCueMovesAsThePacedFinger) {
  for (const int strokes : {1, 2, 3}) {
    schema::ProtocolPace pace = stretch_protocol("1").pace;
    pace.strokes = strokes;
    const playback::FingerPath path = paced_path(pace);
    const double pass_s = path.duration_s();
    EXPECT_EQ(cued_place(pace, -1).part, 0);
    EXPECT_EQ(cued_place(pace, -1).stroke, 0);
    EXPECT_EQ(cued_place(pace, 0.049).stroke, 0);
    for (double t = 0; t < 3 * pass_s; t += 0.0037) {
      const auto pass = static_cast<int>(t / pass_s);
      double on_path_s = t - pass * pass_s;
      if (strokes % 2 == 1 && pass % 2 == 1) on_path_s = pass_s - on_path_s;
      const auto next = std::ranges::upper_bound(path.time_s, on_path_s);
      const auto i = std::min(static_cast<std::size_t>(next - path.time_s.begin()), path.time_s.size() - 1);
      const double share = (on_path_s - path.time_s[i - 1]) / (path.time_s[i] - path.time_s[i - 1]);
      const double place_m = std::lerp(path.position_m[i - 1], path.position_m[i], share);
      const CuedPlace cued = cued_place(pace, t);
      ASSERT_NEAR(pace.from_m + cued.part * (pace.to_m - pace.from_m), place_m, 4e-6) << strokes << " " << t;
      ASSERT_EQ(cued.stroke,
                std::clamp(static_cast<int>(std::ceil((t - pass * pass_s - 0.05) * strokes / (pass_s - 0.1))),
                           0, strokes) +
                    pass * strokes)
          << strokes << " " << t;
    }
    // The speed in the middle of a stroke is the asked one.
    const double middle_s = 0.05 + (pass_s - 0.1) / strokes / 2;
    EXPECT_NEAR((cued_place(pace, middle_s + 0.01).part - cued_place(pace, middle_s).part) *
                    (pace.to_m - pace.from_m) / 0.01,
                pace.speed_mps, 1e-9);
  }
}

TEST(ExperimentRun, TheForceIsBelowWithinOrAboveItsRange) {
  const schema::ForceRange range{0.3, 0.8};
  EXPECT_EQ(pressed_as(range, 0.29), PressedAs::below);
  EXPECT_EQ(pressed_as(range, 0.3), PressedAs::within);
  EXPECT_EQ(pressed_as(range, 0.8), PressedAs::within);
  EXPECT_EQ(pressed_as(range, 0.81), PressedAs::above);
}

schema::IntervalFacts good_facts() {
  schema::IntervalFacts facts;
  facts.ticks = 3000, facts.closed = true, facts.strokes = 2;
  facts.stimulus_sha256 = "sum";
  facts.slowest_mps = 0.05, facts.fastest_mps = 0.06;
  facts.removed_by_limits_db = -300, facts.predicted_error_db = -30;
  return facts;
}

TEST(ExperimentRun, EachLimitDecides) {
  const schema::Protocol protocol = stretch_protocol("1");
  EXPECT_TRUE(reasons_against(good_facts(), protocol, "sum").empty());
  EXPECT_EQ(reasons_against(good_facts(), protocol, "other").size(), 1u);
  const std::vector<void (*)(schema::IntervalFacts&)> faults = {
      [](auto& facts) { facts.closed = false; },
      [](auto& facts) { facts.lost_ticks = 1; },
      [](auto& facts) { facts.fault_ticks = 1; },
      [](auto& facts) { facts.late_ticks = 11; },
      [](auto& facts) { facts.blind_ticks = 1; },
      [](auto& facts) { facts.removed_by_limits_db = -39; },
      [](auto& facts) { facts.strokes = 1; },
      [](auto& facts) { facts.removed_by_limits_db.reset(); },
      [](auto& facts) { facts.predicted_error_db = 0; },
      [](auto& facts) { facts.predicted_error_db.reset(); },
      [](auto& facts) { facts.slowest_mps = 0.04; },
      [](auto& facts) { facts.fastest_mps = 0.09; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    schema::IntervalFacts facts = good_facts();
    faults[i](facts);
    EXPECT_EQ(reasons_against(facts, protocol, "sum").size(), 1u) << i;
    EXPECT_FALSE(judged_delivery(1, {good_facts(), facts}, {"sum", "sum"}, protocol, {}).delivered) << i;
  }
  EXPECT_TRUE(judged_delivery(1, {good_facts(), good_facts()}, {"sum", "sum"}, protocol, {}).delivered);
  EXPECT_FALSE(
      judged_delivery(1, {good_facts(), good_facts()}, {"sum", "sum"}, protocol, {"late"}).delivered);
}

// Of an ordering a stimulus counts if one of its intervals was delivered.
TEST(ExperimentRun, AStimulusThatWasFeltOnceIsDelivered) {
  schema::IntervalFacts other = good_facts(), late = good_facts(), other_late = good_facts();
  other.stimulus_sha256 = other_late.stimulus_sha256 = "other";
  late.late_ticks = other_late.late_ticks = 11;
  const auto delivered = [](const schema::Protocol& protocol, std::vector<schema::IntervalFacts> facts) {
    std::vector<std::string> sums;
    for (const schema::IntervalFacts& each : facts) sums.push_back(each.stimulus_sha256);
    return judged_delivery(1, std::move(facts), sums, protocol, {}).delivered;
  };
  const schema::Protocol ordering = three_orders(), pair = twenty_trials();
  EXPECT_TRUE(delivered(ordering, {late, other, good_facts()}));
  EXPECT_TRUE(delivered(ordering, {good_facts(), other, late, other_late}));
  EXPECT_FALSE(delivered(ordering, {late, other, late}));
  EXPECT_FALSE(delivered(pair, {late, other, good_facts()}));
}

// 75 % at a difference of one Weber fraction, 50 % without a difference, half of the lapses wrong far away.
// The standard deviation of a share of 4000 is 0.8 % at most; the tolerance is four of it.
TEST(ExperimentRun, TheObserverHasItsWeberFractionAndLapses) {
  const auto observer = parse_observer("weber=25%,lapse=10%,seed=3");
  ASSERT_TRUE(observer);
  const auto share_of_first = [&](double longer) {
    double first = 0;
    for (int i = 0; i < 4000; ++i)
      first += smaller_period(*observer, "P/" + std::to_string(i), {0.002, 0.002 * longer}, 0.002) == 1;
    return first / 4000;
  };
  EXPECT_NEAR(share_of_first(1), 0.5, 0.032);
  EXPECT_NEAR(share_of_first(1.25), 0.9 * 0.75 + 0.05, 0.032);
  EXPECT_NEAR(share_of_first(0.75), 0.9 * 0.25 + 0.05, 0.032);
  EXPECT_NEAR(share_of_first(5), 0.95, 0.032);
  EXPECT_EQ(smaller_period(*observer, "P/1", {0.002, 0.0021}, 0.002),
            smaller_period(*observer, "P/1", {0.002, 0.0021}, 0.002));
}

TEST(ExperimentRun, AnObserverThatIsNoneIsRefused) {
  for (const char* text : {"",
                           "weber",
                           "weber=25",
                           "weber=0%",
                           "lapse=2%",
                           "weber=25%,lapse=200%",
                           "webber=25%",
                           "template,weber=25%",
                           "template,noise=-1dB",
                           "template,noise=3",
                           "weber=25%,template",
                           "weber=25%,noise=3dB",
                           "templates",
                           "order,weber=25%",
                           "order,noise=-1dB",
                           "order,sd=3%",
                           "threshold=0%",
                           "threshold=20%,weber=10%",
                           "threshold=20%,noise=1dB",
                           "sd=10%",
                           "threshold=20%,sd=200%",
                           "match=0%,weber=10%",
                           "orders",
                           "weber=25%,order",
                           "weber=25%,seed="}) {
    const auto refused = parse_observer(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().kind, ErrorKind::usage) << text;
  }
  // Its remedy is an observer, of the same task.
  EXPECT_EQ(parse_observer("template,noise=9").error().remedy.find("weber"), std::string::npos);
}

// A sinusoid along an uneven path, rounded to steps of 1 um: the tolerance is the one of the header.
TEST(ExperimentRun, ThePeriodOfASinusoidIsFoundAtUnevenSpeed) {
  for (const double period_m : {0.528e-3, 1.76e-3, 2.992e-3}) {
    std::vector<double> position_m, displacement_m;
    for (int i = 0; i <= 1400; ++i) {
      const double part = i / 1400.0;
      const double x = 0.01 + 0.04 * (part - std::sin(2 * std::numbers::pi * part) / 8);
      position_m.push_back(std::round(x * 1e6) / 1e6);
      displacement_m.push_back(1e-5 * std::sin(2 * std::numbers::pi * x / period_m + 0.3));
    }
    const auto found = spatial_period_m(position_m, displacement_m);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found / period_m, 1, 1e-3);
  }
  EXPECT_FALSE(spatial_period_m(std::vector<double>(20, 0.01), std::vector<double>(20, 1e-5)));
  std::vector<double> position_m(100);
  for (std::size_t i = 0; i < 100; ++i) position_m[i] = 4e-4 * static_cast<double>(i);
  EXPECT_FALSE(spatial_period_m(position_m, std::vector<double>(100, 0.0)));
}

TEST(ExperimentRun, AParticipantHasACode) {
  for (const char* code : {"P01", "7", "lab2x"}) EXPECT_TRUE(schema::check_participant(code)) << code;
  for (const char* code : {"", "Anna", "P 1", "../P1", "P-1"})
    EXPECT_FALSE(schema::check_participant(code)) << code;
}

}  // namespace
}  // namespace tacto::analysis
