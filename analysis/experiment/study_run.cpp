// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/study_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>

#include "analysis/experiment/interval_facts.hpp"
#include "analysis/experiment/interval_play.hpp"
#include "analysis/experiment/live_setting.hpp"
#include "analysis/experiment/masking_noise.hpp"
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

constexpr const char* kNotAccepted = "no setting was accepted";

// The steps of a run on a device.
class LiveSteps {
 public:
  LiveSteps(Run& run, schema::JournalFile& file, const RunRequest& request, bool keeps_time)
      : run_(run), file_(file), request_(request), keeps_time_(keeps_time) {}

  TrialSteps steps() {
    return {[this](const schema::JournalEntry& entry) { return keep(entry); },
            [this](const StudyTrial& trial, int attempt) { return begun(trial, attempt); },
            [this](const Attempt& attempt) { return present(attempt); },
            [this](const Attempt& attempt) { return answer(attempt); },
            [this] { return rest(); },
            [this](const StudyTrial& trial) {
              const double longest_s = run_.study.protocol.longest_s;
              return !trial.is_practice() && longest_s > 0 && block_s(trial.block) >= longest_s;
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

  // Answers since the last break, the beginning, or an interruption.
  int answers_since_break() const {
    int answers = 0;
    for (const schema::JournalEntry& entry : run_.journal.entries) {
      if (std::holds_alternative<schema::AttemptAnswered>(entry)) ++answers;
      if (std::holds_alternative<schema::BreakTaken>(entry) ||
          std::holds_alternative<schema::RunResumed>(entry))
        answers = 0;
    }
    return answers;
  }

  Result<bool> rest() {
    const schema::ProtocolBreaks& breaks = run_.study.protocol.breaks;
    const auto now = BlockClock::now;
    const std::chrono::duration<double> worked = now() - worked_since_;
    const int answers = answers_since_break();
    const bool due = (breaks.after_trials > 0 && answers >= breaks.after_trials) ||
                     (breaks.after_s > 0 && answers > 0 && worked.count() >= breaks.after_s);
    if (!due || !request_.participant.rest) return true;
    const BlockClock::time_point begun = now();
    if (!request_.participant.rest()) return false;
    worked_since_ = now();
    block_since_ += worked_since_ - begun;  // a break is no time of the block
    const std::chrono::duration<double> rested = worked_since_ - begun;
    const schema::BreakTaken taken{rested.count()};
    TACTO_TRY(keep(taken));
    TACTO_TRY(run_.queue.take(taken));
    return true;
  }

  schema::AttemptBegun begun(const StudyTrial& trial, int attempt) {
    schema::AttemptBegun begun{attempt, trial.name(), {}, {}, trial.block, block_s(trial.block)};
    if (task() == schema::Task::ordering) return begun;
    begun.stimuli = {trial.code};
    if (run_.study.protocol.goal == schema::Goal::match)
      begun.stimuli.insert(begun.stimuli.begin(), reference_of(run_.study).code);
    if (task() == schema::Task::two_interval)
      begun.stimuli.insert(trial.standard_comes_first() ? begun.stimuli.begin() : begun.stimuli.end(),
                           standard_of(run_.study.key).code);
    for (std::size_t i = 1; i <= begun.stimuli.size() && !trial.real; ++i)
      begun.sessions.push_back(free_session(attempt, static_cast<int>(i)));
    return begun;
  }

  Result<std::optional<schema::JournalEntry>> present(const Attempt& attempt) {
    request_.tell(static_cast<double>(run_.queue.counted()) / static_cast<double>(run_.queue.trials()));
    if (attempt.trial.is_practice() && request_.participant.practise) request_.participant.practise();
    if (task() == schema::Task::ordering) return explore(attempt);
    if (task() == schema::Task::fidelity) {
      const auto beside = place_beside(attempt);
      TACTO_TRY(beside);
      if (!*beside) return std::nullopt;
    }
    if (!attempt.trial.real) return play(attempt);
    const auto placed = place_sample(attempt.trial.code);
    TACTO_TRY(placed);
    if (!*placed || !go_ahead(1) || request_.stop_asked()) return std::nullopt;
    return schema::SamplePlaced{attempt.begun.attempt, attempt.trial.code};
  }

  // False: the run ends. An observer needs no operator.
  Result<bool> place_sample(const std::string& label) const {
    if (request_.observer) return !request_.stop_asked();
    return request_.participant.place(label, run_.queue.placed());
  }

  // The sample stays for its block.
  Result<bool> place_beside(const Attempt& attempt) {
    const std::string& label = attempt.trial.sample;
    if (run_.queue.sample() == label) return true;
    const auto placed = place_sample(label);
    TACTO_TRY(placed);
    if (!*placed) return false;
    const schema::SamplePlaced entry{attempt.begun.attempt, label};
    TACTO_TRY(keep(entry));
    TACTO_TRY(run_.queue.take(entry));
    return true;
  }

  std::string place(const Attempt& attempt) const {
    return fmt::format("{}/{}", run_.journal.plan.participant, attempt.begun.attempt);
  }

  bool go_ahead(int interval) const { return request_.observer || request_.participant.go_ahead(interval); }

  Result<std::optional<schema::JournalEntry>> play(const Attempt& attempt) {
    IntervalsPlayed played;
    for (std::size_t i = 0; i < attempt.begun.stimuli.size(); ++i) {
      if (!go_ahead(static_cast<int>(i) + 1)) return std::nullopt;
      const bool last = i + 1 == attempt.begun.stimuli.size();
      const auto goes_on = task() == schema::Task::adjustment && last ? adjust(attempt, i, played)
                                                                      : play_one(attempt, i, played);
      TACTO_TRY(goes_on);
      if (!*goes_on) return std::nullopt;
    }
    for (std::size_t i = 0; i < attempt.begun.stimuli.size(); ++i) TACTO_TRY(read_facts(attempt, i, played));
    const auto strokes = static_cast<std::uint64_t>(run_.study.protocol.pace.strokes);
    const bool accepted = std::ranges::find(played.late, kNotAccepted) == played.late.end();
    if (request_.participant.too_early && task() == schema::Task::adjustment && accepted &&
        played.facts.back().strokes < strokes)
      request_.participant.too_early();
    return judgement(attempt, std::move(played));
  }

  // The intervals of an attempt, in order, and reasons that are in no session.
  struct IntervalsPlayed {
    std::vector<schema::IntervalFacts> facts;
    std::vector<std::string> sums, late;
    std::vector<std::optional<double>> force_within;  // if the protocol has a range
  };

  schema::DeliveryJudged judgement(const Attempt& attempt, IntervalsPlayed played) const {
    auto judged = judged_delivery(attempt.begun.attempt, std::move(played.facts), played.sums,
                                  run_.study.protocol, played.late);
    judged.force_within = std::move(played.force_within);
    return judged;
  }

  IntervalPlay interval_of(const Attempt& attempt, std::size_t i) const {
    IntervalPlay interval{request_.device_uri,
                          run_.study.stimulus(attempt.begun.stimuli[i]),
                          full(attempt.begun.sessions[i]),
                          false,
                          request_.stop_asked,
                          task() == schema::Task::amplitude ? attempt.trial.ratio : 1,
                          {}};
    const bool alone = task() == schema::Task::ordering;
    interval.hurried =
        request_.observer &&
        hurries(*request_.observer, alone ? fmt::format("{}/{}", place(attempt), i) : place(attempt));
    return interval;
  }

  // False: the run ends.
  Result<bool> play_one(const Attempt& attempt, std::size_t i, IntervalsPlayed& played) {
    return play_interval_of(interval_of(attempt, i), played);
  }

  Result<bool> play_interval_of(IntervalPlay interval, IntervalsPlayed& played) const {
    IntervalGuide guide(run_.study.protocol, request_.participant.guide);
    interval.watch = std::ref(guide);
    const auto late = play_interval(run_.study.protocol, interval);
    TACTO_TRY(late);
    if (request_.stop_asked()) return false;
    if (!late->empty()) played.late.push_back(*late);
    if (run_.study.protocol.normal_force) played.force_within.push_back(guide.force_within());
    return true;
  }

  Result<void> read_facts(const Attempt& attempt, std::size_t i, IntervalsPlayed& played) const {
    auto facts = interval_facts(full(attempt.begun.sessions[i]));
    TACTO_TRY(facts);
    played.facts.push_back(std::move(*facts));
    played.sums.push_back(stimulus_of(run_.study.key, attempt.begun.stimuli[i]).sha256);
    return {};
  }

  Result<bool> adjust(const Attempt& attempt, std::size_t i, IntervalsPlayed& played) {
    const schema::Protocol& protocol = run_.study.protocol;
    std::optional<double> wanted;
    if (request_.observer) {
      wanted = criterion_of(*request_.observer, place(attempt), attempt.trial.is_ascending());
    } else if (request_.participant.wanted) {
      wanted = request_.participant.wanted(run_.queue.answers());
      if (!wanted) return false;
    }
    const AskedAt asked_at = request_.observer        ? AskedAt::pass_with_ratio
                             : wanted || !keeps_time_ ? AskedAt::pass
                                                      : AskedAt::any_time;
    IntervalPlay interval = interval_of(attempt, i);
    interval.ratio = attempt.trial.ratio;
    const double pass_s = paced_path(pace_of(protocol, interval)).duration_s();
    schema::Turn before = schema::Turn::accept;
    const auto ask = [&](const SettingNow& now) -> Result<std::optional<schema::Turn>> {
      if (!wanted) return request_.participant.turn(asked_at == AskedAt::pass);
      const double measured = request_.observer ? now.presented_ratio : now.ratio;
      // Where ticks are missing nothing was played, and then the attempt is not delivered.
      const schema::Turn turn =
          measured > 0 ? turn_towards(protocol, now.ratio, measured, *wanted) : schema::Turn::accept;
      // Between two settings that are equally near.
      const bool back = before != schema::Turn::accept && turn != before;
      before = back ? schema::Turn::accept : turn;
      return before;
    };
    LiveSetting setting(protocol, interval.session, pass_s, attempt.trial.ratio, asked_at, ask);
    interval.steer = std::ref(setting);
    const auto goes_on = play_interval_of(std::move(interval), played);
    if (goes_on && !setting.accepted()) played.late.emplace_back(kNotAccepted);
    return goes_on;
  }

  // How often each texture has yet to be explored: 0 times if it was delivered, or failed too often.
  Result<std::optional<schema::JournalEntry>> explore(const Attempt& attempt) {
    IntervalsPlayed played;
    std::vector<int> tries(attempt.trial.arranged.size(), run_.study.protocol.most_attempts);
    while (true) {
      std::vector<int> left;
      for (std::size_t i = 0; i < tries.size(); ++i)
        if (tries[i] > 0) left.push_back(static_cast<int>(i) + 1);
      const auto next = request_.observer ? std::optional(left.empty() ? 0 : left.front())
                                          : request_.participant.explore(left);
      if (!next || request_.stop_asked()) return std::nullopt;
      if (*next == 0) break;
      const auto chosen = static_cast<std::size_t>(*next) - 1;
      const std::size_t i = attempt.begun.stimuli.size();
      const schema::StimulusExplored explored{attempt.begun.attempt, attempt.trial.arranged[chosen],
                                              free_session(attempt.begun.attempt, static_cast<int>(i) + 1)};
      TACTO_TRY(keep(explored));
      TACTO_TRY(run_.queue.take(explored));
      const auto goes_on = play_one(attempt, i, played);
      TACTO_TRY(goes_on);
      if (!*goes_on) return std::nullopt;
      TACTO_TRY(read_facts(attempt, i, played));
      const bool delivered =
          reasons_against(played.facts.back(), run_.study.protocol, played.sums.back()).empty();
      tries[chosen] = delivered ? 0 : std::max(tries[chosen] - 1, 0);
    }
    return judgement(attempt, std::move(played));
  }

  // By the displacement that the sessions predict; the mean level of a texture's intervals.
  GivenAnswer order_by_level(const Attempt& attempt) const {
    std::vector<std::pair<double, int>> levels;
    for (const std::string& code : attempt.trial.arranged) {
      double sum_db = 0, count = 0;
      for (std::size_t i = 0; i < attempt.begun.stimuli.size(); ++i) {
        if (attempt.begun.stimuli[i] != code) continue;
        const auto rms_m = predicted_rms_m(full(attempt.begun.sessions[i]));
        if (!rms_m) continue;  // ticks are missing: it is not delivered
        sum_db += perceived_level_db(*request_.observer, fmt::format("{}/{}", place(attempt), i), *rms_m);
        ++count;
      }
      levels.emplace_back(count > 0 ? sum_db / count : 0, static_cast<int>(levels.size()) + 1);
    }
    std::ranges::sort(levels);
    GivenAnswer answer;
    for (const auto& [level_db, number] : levels) answer.order.push_back(number);
    return answer;
  }

  std::string order_in_words(const Attempt& attempt, const std::vector<int>& order) const {
    std::vector<std::string> codes;
    for (const int number : order)
      codes.push_back(attempt.trial.arranged[static_cast<std::size_t>(number) - 1]);
    return fmt::format("{}", fmt::join(codes, " "));
  }

  Result<std::optional<schema::AttemptAnswered>> answer(const Attempt& attempt) {
    const auto given = given_answer(attempt);
    TACTO_TRY(given);
    if (!*given) return std::nullopt;
    const int choice = (*given)->choice;
    if (task() == schema::Task::ordering)
      return schema::AttemptAnswered{attempt.begun.attempt, 0, order_in_words(attempt, (*given)->order),
                                     (*given)->answer_s};
    if (choice == 0) return schema::AttemptAnswered{attempt.begun.attempt, 0, "none", 0};
    const std::string& word = run_.study.protocol.choices[static_cast<std::size_t>(choice) - 1].word;
    return schema::AttemptAnswered{attempt.begun.attempt, choice, word, (*given)->answer_s};
  }

  // Which standard it is to the observer.
  Result<int> identified(const Attempt& attempt) {
    if (!templates_) {
      auto templates = TemplateObserver::of(run_.study);
      TACTO_TRY(templates);
      templates_ = std::move(*templates);
    }
    const std::optional<std::string> session =
        attempt.trial.real ? std::nullopt : std::optional(full(attempt.begun.sessions.front()));
    return templates_->answer(*request_.observer, place(attempt), attempt.trial.code, session);
  }

  Result<std::optional<GivenAnswer>> given_answer(const Attempt& attempt) {
    if (task() == schema::Task::adjustment) return GivenAnswer{accepted_choice(attempt), 0};
    if (!request_.observer) return request_.participant.answer(run_.queue.answers());
    if (task() == schema::Task::ordering) return order_by_level(attempt);
    if (task() == schema::Task::identification || task() == schema::Task::fidelity) {
      const auto number = identified(attempt);
      TACTO_TRY(number);
      if (task() == schema::Task::identification) return GivenAnswer{*number, 0};
      const std::string& name = run_.study.protocol.standards[static_cast<std::size_t>(*number) - 1];
      const bool same = stimulus_of(run_.study.key, attempt.trial.sample).name == name;
      return GivenAnswer{same ? schema::kSameChoice : schema::kSameChoice + 1, 0};
    }
    const auto& intervals = attempt.judged->intervals;
    if (task() == schema::Task::amplitude) {
      const double ratio = ratio_by(Displacement::predicted, run_, attempt).value_or(0);
      return GivenAnswer{rated(*request_.observer, place(attempt), ratio) + schema::kLargestRating + 1, 0};
    }
    const int choice = smaller_period(*request_.observer, place(attempt),
                                      {intervals[0].predicted_period_m, intervals[1].predicted_period_m},
                                      run_.study.protocol.standard.period_m);
    return GivenAnswer{choice, 0};
  }

  // The setting was accepted in the session, before it was judged.
  static int accepted_choice(const Attempt& attempt) {
    const bool none = std::ranges::find(attempt.judged->why, kNotAccepted) != attempt.judged->why.end();
    return none ? 0 : static_cast<int>(schema::Turn::accept);
  }

  schema::Task task() const { return run_.study.protocol.task; }

  Run& run_;
  schema::JournalFile& file_;
  const RunRequest& request_;
  bool keeps_time_;
  std::optional<TemplateObserver> templates_;
  int block_ = 0;
  double block_base_s_ = 0;
  BlockClock::time_point block_since_, worked_since_ = BlockClock::now();
};

// The row of block orders that the fewest complete runs have. A journal that cannot be read is of no
// complete run. Errors: unsuitable: a run of another protocol or key, with which this one could not be
// analysed.
Result<int> next_order(const Study& study) {
  std::vector<int> complete(static_cast<std::size_t>(study.protocol.task == schema::Task::identification
                                                         ? williams_rows(study.protocol.conditions.size())
                                                         : 1));
  for (const std::string& stem : runs_of(study)) {
    const auto journal = schema::read_journal(schema::journal_path(stem));
    if (!journal) continue;
    TACTO_TRY(check_unchanged(journal->plan, study));
    const auto row = static_cast<std::size_t>(journal->plan.order) - 1;
    if (std::holds_alternative<schema::RunEnded>(journal->entries.back()) && row < complete.size())
      ++complete[row];
  }
  return static_cast<int>(std::ranges::min_element(complete) - complete.begin()) + 1;
}

Result<void> check_observer(const schema::Protocol& protocol, const std::optional<Observer>& observer) {
  constexpr const char* kExamples[] = {"weber=25.3%",          "template",
                                       "match=86%,weber=10%",  "order,noise=1dB",
                                       "threshold=20%,sd=10%", "template"};
  const bool compares = protocol.task == schema::Task::fidelity;  // the template that it identifies
  if (!observer || observer->task == (compares ? schema::Task::identification : protocol.task)) return {};
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
Result<void> go_on(Run& run, schema::JournalFile& file, const RunRequest& request, bool keeps_time,
                   const schema::JournalEntry& first) {
  LiveSteps live(run, file, request, keeps_time);
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
  const auto masking_level = checked_masking_level(study->protocol, request.masking_level_db);
  TACTO_TRY(masking_level);
  const auto order = next_order(*study);
  TACTO_TRY(order);
  const auto slowest = check_on_device(*study, request.device_uri);
  TACTO_TRY(slowest);
  const std::string stem = study->run(participant);
  auto file = schema::JournalFile::create(schema::journal_path(stem));
  TACTO_TRY(file);
  schema::RunPlanned plan{
      study->name(),           participant,           study->protocol.sha256,
      study->key.sha256,       request.device_uri,    request.observer ? request.observer->text : "",
      schema::creation_time(), std::string(kCreator), *order,
      request.language,        *masking_level};
  TrialQueue queue = queue_of_run(study->protocol, study->key, participant, *order);
  Run run{stem, {plan, {}, 0}, std::move(*study), std::move(queue)};
  TACTO_TRY(go_on(run, *file, request, slowest->keeps_time(), plan));
  return run;
}

Result<Run> resume_run(const std::string& name, RunRequest request) {
  schema::Journal journal;
  auto file = schema::JournalFile::resume(schema::journal_path(name), journal);
  TACTO_TRY(file);
  auto run = run_of(schema::run_stem(name), std::move(journal));
  TACTO_TRY(run);
  if (run->queue.has_ended())
    return fail(ErrorKind::usage, "this run is complete", schema::journal_path(name),
                "prove it, or analyse the study");
  const schema::RunPlanned& plan = run->journal.plan;
  if (request.device_uri.empty()) request.device_uri = plan.device;
  request.observer.reset();
  if (!plan.observer.empty()) {
    auto observer = parse_observer(plan.observer);
    TACTO_TRY(observer);
    request.observer = std::move(*observer);
  }
  const auto masking_level = checked_masking_level(run->study.protocol, request.masking_level_db);
  TACTO_TRY(masking_level);
  const auto slowest = check_on_device(run->study, request.device_uri);
  TACTO_TRY(slowest);
  TACTO_TRY(go_on(*run, *file, request, slowest->keeps_time(),
                  schema::RunResumed{schema::creation_time(), *masking_level}));
  return std::move(*run);
}

}  // namespace tacto::analysis
