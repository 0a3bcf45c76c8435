// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/study_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "analysis/experiment/interval_facts.hpp"
#include "analysis/experiment/interval_play.hpp"
#include "analysis/experiment/study_answers.hpp"
#include "analysis/experiment/template_observer.hpp"
#include "analysis/experiment/trial_runner.hpp"
#include "analysis/experiment/withdrawal.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

using BlockClock = std::chrono::steady_clock;

// The steps of a run on a device.
class LiveSteps {
 public:
  LiveSteps(Run& run, schema::JournalFile& file, const RunRequest& request)
      : run_(run), file_(file), request_(request) {}

  TrialSteps steps() {
    return {[this](const schema::JournalEntry& entry) { return keep(entry); },
            [this](const StudyTrial& trial, int attempt) { return begun(trial, attempt); },
            [this](const Attempt& attempt) { return present(attempt); },
            [this](const Attempt& attempt) { return answer(attempt); },
            [this](const StudyTrial& trial) {
              const double longest_s = run_.study.protocol.longest_s;
              return longest_s > 0 && block_s(trial.block) >= longest_s;
            }};
  }

  Result<void> keep(const schema::JournalEntry& entry) {
    run_.journal.entries.push_back(entry);
    return file_.append(entry);
  }

 private:
  // A session of an attempt whose line was lost keeps its name.
  std::string free_session(int attempt, int interval) const {
    const std::string folder = std::filesystem::path(run_.stem).filename().string();
    std::string name = fmt::format("{}/{:03}-{}", folder, attempt, interval);
    while (schema::is_file(full(name + ".session"))) name += "x";
    return name + ".session";
  }

  std::string full(const std::string& session) const {
    return (std::filesystem::path(run_.stem).parent_path() / session).string();
  }

  // Since the block began: what the journal has of it, and the time since this process continued it.
  double block_s(int block) {
    if (block != block_) {
      block_ = block, block_base_s_ = 0, block_since_ = BlockClock::now();
      for (const Attempt& attempt : run_.queue.attempts())
        if (attempt.begun.block == block) block_base_s_ = attempt.begun.block_s;
    }
    return block_base_s_ + std::chrono::duration<double>(BlockClock::now() - block_since_).count();
  }

  schema::AttemptBegun begun(const StudyTrial& trial, int attempt) {
    schema::AttemptBegun begun{attempt, trial.name(), {trial.code}, {}, trial.block, block_s(trial.block)};
    if (run_.study.protocol.task == schema::Task::two_interval)
      begun.stimuli.insert(trial.standard_comes_first() ? begun.stimuli.begin() : begun.stimuli.end(),
                           standard_of(run_.study.key).code);
    for (std::size_t i = 1; i <= begun.stimuli.size() && !trial.real; ++i)
      begun.sessions.push_back(free_session(attempt, static_cast<int>(i)));
    return begun;
  }

  Result<std::optional<schema::JournalEntry>> present(const Attempt& attempt) {
    request_.tell(static_cast<double>(run_.queue.counted()) / static_cast<double>(run_.queue.trials()));
    if (!attempt.trial.real) return play(attempt);
    const std::string& label = attempt.trial.code;
    if (!request_.observer) {
      const auto is_placed = request_.participant.place(label, run_.queue.placed());
      TACTO_TRY(is_placed);
      if (!*is_placed || !go_ahead(1)) return std::nullopt;
    }
    if (request_.stop_asked()) return std::nullopt;
    return schema::SamplePlaced{attempt.begun.attempt, label};
  }

  std::string place(const Attempt& attempt) const {
    return fmt::format("{}/{}", run_.journal.plan.participant, attempt.begun.attempt);
  }

  bool go_ahead(int interval) const { return request_.observer || request_.participant.go_ahead(interval); }

  Result<std::optional<schema::JournalEntry>> play(const Attempt& attempt) {
    std::vector<std::string> late, sums;
    IntervalPlay interval{request_.device_uri, {}, {}, false, request_.stop_asked, attempt.trial.ratio};
    interval.hurried = request_.observer && hurries(*request_.observer, place(attempt));
    for (std::size_t i = 0; i < attempt.begun.stimuli.size(); ++i) {
      if (!go_ahead(static_cast<int>(i) + 1)) return std::nullopt;
      interval.stimulus = run_.study.stimulus(attempt.begun.stimuli[i]);
      interval.session = full(attempt.begun.sessions[i]);
      sums.push_back(stimulus_of(run_.study.key, attempt.begun.stimuli[i]).sha256);
      const auto played = play_interval(run_.study.protocol, interval);
      TACTO_TRY(played);
      if (request_.stop_asked()) return std::nullopt;
      if (!played->empty()) late.push_back(*played);
    }
    std::vector<schema::IntervalFacts> facts;
    for (const std::string& session : attempt.begun.sessions) {
      auto each = interval_facts(full(session));
      TACTO_TRY(each);
      facts.push_back(std::move(*each));
    }
    return judged_delivery(attempt.begun.attempt, std::move(facts), sums, run_.study.protocol, late);
  }

  Result<std::optional<schema::AttemptAnswered>> answer(const Attempt& attempt) {
    const auto given = given_answer(attempt);
    TACTO_TRY(given);
    if (!*given) return std::nullopt;
    const int choice = (*given)->choice;
    const std::string& word = run_.study.protocol.choices[static_cast<std::size_t>(choice) - 1].word;
    return schema::AttemptAnswered{attempt.begun.attempt, choice, word, (*given)->answer_s};
  }

  Result<std::optional<GivenAnswer>> given_answer(const Attempt& attempt) {
    if (!request_.observer) return request_.participant.answer(run_.queue.answers());
    if (run_.study.protocol.task == schema::Task::identification) {
      if (!templates_) {
        auto templates = TemplateObserver::of(run_.study);
        TACTO_TRY(templates);
        templates_ = std::move(*templates);
      }
      const std::optional<std::string> session =
          attempt.trial.real ? std::nullopt : std::optional(full(attempt.begun.sessions.front()));
      return GivenAnswer{templates_->answer(*request_.observer, place(attempt), attempt.trial.code, session),
                         0};
    }
    const auto& intervals = attempt.judged->intervals;
    if (run_.study.protocol.task == schema::Task::amplitude) {
      const double ratio = predicted_ratio(run_, attempt).value_or(0);
      return GivenAnswer{rated(*request_.observer, place(attempt), ratio) + schema::kLargestRating + 1, 0};
    }
    const int choice = smaller_period(*request_.observer, place(attempt),
                                      {intervals[0].predicted_period_m, intervals[1].predicted_period_m},
                                      run_.study.protocol.standard.period_m);
    return GivenAnswer{choice, 0};
  }

  Run& run_;
  schema::JournalFile& file_;
  const RunRequest& request_;
  std::optional<TemplateObserver> templates_;
  int block_ = 0;
  double block_base_s_ = 0;
  BlockClock::time_point block_since_;
};

// The row of block orders that the fewest complete runs have. A journal that cannot be read is of no
// complete run.
int next_order(const Study& study) {
  std::vector<int> complete(static_cast<std::size_t>(study.protocol.task == schema::Task::identification
                                                         ? williams_rows(study.protocol.conditions.size())
                                                         : 1));
  for (const std::string& stem : runs_of(study)) {
    const auto journal = schema::read_journal(schema::journal_path(stem));
    if (!journal) continue;
    const auto row = static_cast<std::size_t>(journal->plan.order) - 1;
    if (std::holds_alternative<schema::RunEnded>(journal->entries.back()) && row < complete.size())
      ++complete[row];
  }
  return static_cast<int>(std::ranges::min_element(complete) - complete.begin()) + 1;
}

Result<void> check_observer(const schema::Protocol& protocol, const std::optional<Observer>& observer) {
  constexpr const char* kExamples[] = {"weber=25.3%", "template", "match=86%,weber=10%"};
  if (!observer || observer->task() == protocol.task) return {};
  return fail(
      ErrorKind::usage,
      fmt::format("'{}' cannot answer in the task {}", observer->text, schema::word_of(protocol.task)),
      "--observer", fmt::format("give for example {}", kExamples[static_cast<int>(protocol.task)]));
}

Result<void> write_table(const Run& run) {
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(run.stem + ".trials.tsv", trials_table(run)));
  return pending.commit();
}

// Runs what is left. `first`: the entry with which this begins.
Result<void> go_on(Run& run, schema::JournalFile& file, const RunRequest& request,
                   const schema::JournalEntry& first) {
  LiveSteps live(run, file, request);
  TACTO_TRY(live.keep(first));
  TACTO_TRY(run.queue.take(first));
  TACTO_TRY(run_trials(run.queue, live.steps()));
  return run.queue.has_ended() ? write_table(run) : Result<void>();
}

}  // namespace

Result<Run> begin_run(const std::string& study_name, const std::string& participant,
                      const RunRequest& request) {
  TACTO_TRY(schema::check_participant(participant));
  auto study = read_study(study_name);
  TACTO_TRY(study);
  TACTO_TRY(check_not_withdrawn(study->stem, participant));
  TACTO_TRY(check_observer(study->protocol, request.observer));
  TACTO_TRY(check_on_device(*study, request.device_uri));
  const int order = next_order(*study);
  const std::string stem = study->run(participant);
  auto file = schema::JournalFile::create(schema::journal_path(stem));
  TACTO_TRY(file);
  schema::RunPlanned plan{
      study->name(),           participant,           study->protocol.sha256,
      study->key.sha256,       request.device_uri,    request.observer ? request.observer->text : "",
      schema::creation_time(), std::string(kCreator), order};
  TrialQueue queue(ordered_trials(study->protocol, study->key, participant, order),
                   study->protocol.most_attempts);
  Run run{stem, {plan, {}, 0}, std::move(*study), std::move(queue)};
  TACTO_TRY(go_on(run, *file, request, plan));
  return run;
}

Result<Run> resume_run(const std::string& name, RunRequest request) {
  schema::Journal journal;
  auto file = schema::JournalFile::resume(schema::journal_path(name), journal);
  TACTO_TRY(file);
  auto run = run_of(schema::run_stem(name), std::move(journal));
  TACTO_TRY(run);
  if (run->queue.has_ended())
    return fail(ErrorKind::usage, "this run is complete", schema::journal_path(name), "");
  const schema::RunPlanned& plan = run->journal.plan;
  if (request.device_uri.empty()) request.device_uri = plan.device;
  request.observer.reset();
  if (!plan.observer.empty()) {
    auto observer = parse_observer(plan.observer);
    TACTO_TRY(observer);
    request.observer = std::move(*observer);
  }
  TACTO_TRY(check_on_device(run->study, request.device_uri));
  TACTO_TRY(go_on(*run, *file, request, schema::RunResumed{schema::creation_time()}));
  return std::move(*run);
}

}  // namespace tacto::analysis
