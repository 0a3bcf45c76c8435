// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/experiment_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "analysis/cli/participant_screen.hpp"
#include "analysis/experiment/interval_play.hpp"
#include "analysis/experiment/marked_proof.hpp"
#include "analysis/experiment/masking_noise.hpp"
#include "analysis/experiment/study_answers.hpp"
#include "analysis/experiment/study_export.hpp"
#include "analysis/experiment/study_power.hpp"
#include "analysis/experiment/study_run.hpp"
#include "analysis/experiment/trial_runner.hpp"
#include "analysis/experiment/withdrawal.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

struct NewStudyOptions {
  std::string what, stem, seed = "1", reference;
  std::vector<std::string> textures, comparisons;
  std::vector<double> intended;
  schema::Goal goal = schema::Goal::least;
  schema::LevelMethod method = schema::LevelMethod::constant;
  std::optional<double> masking_db;
  bool pacing_cue = false;
  std::vector<std::string> normal_force;
  schema::Existing existing = schema::Existing::keep;
};

struct CheckStudyOptions {
  std::string study, device;
};

struct RunStudyOptions {
  std::string what;  ///< the study, or the run to be resumed
  std::string device, participant, observer, answers, language = schema::kUsualLanguage;
  std::optional<double> masking_level_db;
};

constexpr const char* kDeviceHelp =
    "Device: usb:, sim: ... (as of 'play'; an emulated finger moves at the protocol's pace)";
constexpr const char* kAnswersHelp =
    "File with an answer on each line, its word or its key, and between them the labels (K3) of the real "
    "samples that the operator places; of ordering the numbers from least to most (2 1 3); of adjustment the "
    "ratio that is set (0.25; the nearest step is used, and printed); default: the keys of this terminal";

std::string force_in_words(const std::optional<schema::ForceRange>& range) {
  if (!range) return "none";
  const auto words = [](double force_n) { return schema::for_people(force_n, schema::Dimension::force); };
  return fmt::format("{} to {}", words(range->low_n), words(range->high_n));
}

Report study_report(const Study& study) {
  const schema::Protocol& protocol = study.protocol;
  Report report;
  report.add("study", study.stem).add("task", schema::word_of(protocol.task));
  if (protocol.task == schema::Task::two_interval)
    report.add("levels", protocol.levels.size()).add("method", schema::word_of(protocol.method));
  else if (protocol.task == schema::Task::amplitude)
    report.add("largest_ratio", protocol.largest_ratio);
  else if (protocol.task == schema::Task::adjustment)
    report.add("goal", schema::word_of(protocol.goal))
        .add("smallest_ratio", protocol.smallest_ratio)
        .add("largest_ratio", protocol.largest_ratio)
        .add("step_db", protocol.step_db);
  else if (protocol.task == schema::Task::ordering || protocol.task == schema::Task::fidelity)
    report.add("standards", protocol.standards.size());
  else
    report.add("standards", protocol.standards.size())
        .add("comparisons", protocol.comparisons.size())
        .add("conditions", protocol.conditions.size());
  report.add("repetitions", protocol.repetitions)
      .add("trials", ordered_trials(protocol, study.key, "P1", 1).size());
  if (protocol.practice > 0) report.add("practice", protocol.practice);
  std::vector<std::string> languages;
  for (const auto& [language, texts] : protocol.texts) languages.push_back(language);
  report.add("languages", languages).add("masking_noise", noise_in_words(protocol.masking_noise));
  report.add("pacing_cue", protocol.pace.cue).add("normal_force", force_in_words(protocol.normal_force));
  return report.add("interval_s", paced_path(protocol.pace).duration_s());
}

Result<Report> warn_and_report(const Study& study) {
  const auto notes = lost_band(study);
  TACTO_TRY(notes);
  for (const std::string& note : *notes) cli::warn(note);
  return study_report(study);
}

// Of a protocol that comes with tactograph, the options that only it has.
struct KnownProtocol {
  const char* name;
  std::vector<std::string> options;
};
const std::vector<KnownProtocol> kKnownProtocols = {{"stretch", {"--method"}},
                                                    {"identification", {"--textures", "--comparisons"}},
                                                    {"fidelity", {"--textures"}},
                                                    {"amplitude", {"--textures"}},
                                                    {"ordering", {"--textures", "--intended"}},
                                                    {"adjustment", {"--textures", "--goal", "--reference"}}};

Result<void> check_new_options(const NewStudyOptions& o, const std::vector<std::string>& given) {
  const auto known = std::ranges::find(kKnownProtocols, o.what, &KnownProtocol::name);
  if (known == kKnownProtocols.end())
    return schema::fail(
        ErrorKind::usage, fmt::format("'{}' is not a protocol that comes with tactograph", o.what),
        "experiment new", "there are: stretch, identification, fidelity, amplitude, ordering, adjustment");
  for (const std::string& option : given)
    if (std::ranges::find(known->options, option) == known->options.end())
      return schema::fail(ErrorKind::usage, fmt::format("is no option of {}", o.what), option,
                          "leave it out");
  return {};
}

std::string name_of_texture(const std::string& file) {
  return std::filesystem::path(schema::stem_of(file, ".texture")).filename().string();
}

Result<void> read_named(const std::vector<std::string>& files, NamedTextures& textures) {
  for (const std::string& file : files) {
    auto texture = schema::read_texture(file);
    TACTO_TRY(texture);
    const std::string name = name_of_texture(file);
    if (!textures.emplace(name, std::move(*texture)).second)
      return schema::fail(ErrorKind::usage, name + " is named twice", "--textures", "name each texture once");
  }
  return {};
}

Result<schema::Protocol> new_ordering(const NewStudyOptions& o, const NamedTextures& textures) {
  if (!o.intended.empty() && o.intended.size() != o.textures.size())
    return schema::fail(ErrorKind::usage,
                        fmt::format("has {} numbers for {} textures", o.intended.size(), o.textures.size()),
                        "--intended", "give one for each texture, in their order");
  std::map<std::string, double> intended;
  for (std::size_t i = 0; i < o.intended.size(); ++i)
    intended[name_of_texture(o.textures[i])] = o.intended[i];
  return ordering_protocol(o.seed, textures, intended);
}

Result<schema::Protocol> new_adjustment(const NewStudyOptions& o, NamedTextures& textures) {
  if (o.textures.size() != 1)
    return schema::fail(ErrorKind::usage, fmt::format("there are {} textures", o.textures.size()),
                        "--textures", "name one, which is adjusted");
  if (!o.reference.empty() && o.goal != schema::Goal::match)
    return schema::fail(ErrorKind::usage, fmt::format("the goal {} has none", schema::word_of(o.goal)),
                        "--reference", "leave it out, or add --goal match");
  const std::string adjusted = name_of_texture(o.textures.front());
  const auto folder_of = [](const std::string& name) {
    return std::filesystem::absolute(name).lexically_normal().parent_path();
  };
  if (!o.reference.empty() && name_of_texture(o.reference) != adjusted)
    TACTO_TRY(read_named({o.reference}, textures));
  else if (!o.reference.empty() && folder_of(o.reference) != folder_of(o.textures.front()))
    return schema::fail(ErrorKind::usage, fmt::format("two textures have the name {}", adjusted),
                        "--reference", "rename one of them");
  return adjustment_protocol(o.seed, textures, adjusted, o.goal);
}

// Takes the textures that the protocol is of.
Result<schema::Protocol> new_protocol(const NewStudyOptions& o, NamedTextures& textures) {
  if (o.what == "stretch") return stretch_protocol(o.seed, o.method);
  TACTO_TRY(read_named(o.textures, textures));
  if (o.what == "fidelity") return fidelity_protocol(o.seed, textures);
  if (o.what == "amplitude") return amplitude_protocol(o.seed, textures);
  if (o.what == "ordering") return new_ordering(o, textures);
  if (o.what == "adjustment") return new_adjustment(o, textures);
  std::vector<std::string> comparisons = o.comparisons;
  if (comparisons.empty())
    for (const auto& [name, texture] : textures) comparisons.push_back(name);
  return identification_protocol(o.seed, textures, comparisons);
}

Result<schema::ForceRange> parse_force_range(const std::vector<std::string>& ends) {
  std::vector<double> forces_n;
  for (const std::string& end : ends) {
    const auto force_n = schema::parse_quantity(end, schema::Dimension::force);
    if (!force_n)
      return schema::fail(ErrorKind::usage, force_n.error().what, "--normal-force", force_n.error().remedy);
    forces_n.push_back(*force_n);
  }
  if (forces_n.size() == 2 && 0 <= forces_n[0] && forces_n[0] < forces_n[1])
    return schema::ForceRange{forces_n[0], forces_n[1]};
  return schema::fail(ErrorKind::usage, "needs the lowest and the highest force", "--normal-force",
                      "give for example 0.3N,0.8N");
}

Result<Report> run_new_study(const NewStudyOptions& o) {
  NamedTextures textures;
  auto protocol = new_protocol(o, textures);
  TACTO_TRY(protocol);
  if (o.masking_db) protocol->masking_noise = usual_masking_noise(*o.masking_db);
  if (o.pacing_cue) add_pacing_cue(*protocol);
  if (!o.normal_force.empty()) {
    const auto range = parse_force_range(o.normal_force);
    TACTO_TRY(range);
    add_normal_force(*protocol, *range);
  }
  const auto study = write_study(o.stem.empty() ? o.what : o.stem, *protocol, textures, o.existing);
  TACTO_TRY(study);
  auto report = warn_and_report(*study);
  TACTO_TRY(report);
  std::vector<std::string> keys;
  for (const auto& [key, word] : protocol->choices) keys.push_back(fmt::format("{}: {}", key, word));
  report->add("answer_keys", keys);
  report->add("written", std::vector<std::string>{schema::protocol_path(study->stem),
                                                  schema::key_path(study->stem), study->stem + "/"});
  return report->add("next",
                     fmt::format("tactograph experiment check {} -d DEVICE", cli::shell_word(study->stem)));
}

Result<Report> run_check_study(const CheckStudyOptions& o) {
  const auto study = read_study(o.study);
  TACTO_TRY(study);
  std::optional<SlowestLoad> slowest;
  if (!o.device.empty()) {
    auto loaded = check_on_device(*study, o.device);
    TACTO_TRY(loaded);
    slowest = std::move(*loaded);
  }
  auto report = warn_and_report(*study);
  TACTO_TRY(report);
  if (study->protocol.normal_force) {
    const auto reported = o.device.empty() ? Result<bool>(false) : reports_normal_force(o.device);
    TACTO_TRY(reported);
    report->add("normal_force_reported", o.device.empty() ? "not checked: no device is named"
                                         : *reported      ? "yes"
                                                          : "no");
    if (!o.device.empty() && !*reported)
      cli::warn(
          "this device reports no normal force: the screen says nothing of it, and the trials 'unknown'");
  }
  report->add("lead_s", study->protocol.lead_s);
  if (!slowest)
    report->add("slowest_load", "not measured: no device is named");
  else if (slowest->code.empty())
    report->add("slowest_load", "not measured: this device does not keep time");
  else
    report->add("slowest_load_s", slowest->time_s);
  if (slowest && study->protocol.lead_s < kUsualLeadOverLoad * slowest->time_s)
    cli::warn(
        fmt::format("the lead of {:g} s is less than {:g} times the slowest load, {:.3f} s, and each "
                    "stimulus was loaded only once: "
                    "an interval may begin late",
                    study->protocol.lead_s, kUsualLeadOverLoad, slowest->time_s));
  report->add("valid", true);
  return report->add("next", fmt::format("tactograph experiment run {} -d {} --participant P01",
                                         cli::shell_word(study->stem),
                                         o.device.empty() ? "DEVICE" : cli::shell_word(o.device)));
}

// Trials that have no answer, and will get none.
void add_lost_trials(Report& report, const TrialQueue& queue) {
  if (queue.abandoned() > 0) report.add("abandoned", queue.abandoned());
  if (queue.timed_out() > 0) report.add("after_time_limit", queue.timed_out());
}

// Counts only: no screen names a stimulus.
Report progress_row(const std::string& stem, const TrialQueue& queue) {
  Report row;
  row.add("run", stem).add("complete", queue.has_ended());
  row.add("trials", queue.trials()).add("delivered_and_answered", queue.counted());
  row.add("attempts", queue.tried());
  add_lost_trials(row, queue);
  return row;
}

Report report_of_run(const Run& run) {
  Report report = progress_row(run.stem, run.queue);
  if (!run.journal.plan.observer.empty()) report.add("simulated", observer_in_words(run));
  if (run.study.protocol.masking_noise) report.add("masking_noise", noise_of_run(run));
  std::vector<std::string> written = {schema::journal_path(run.stem), run.stem + "/"};
  if (run.queue.has_ended()) written.push_back(run.stem + ".trials.tsv");
  report.add("written", written);
  if (!run.queue.has_ended())
    return report.add("next", "tactograph experiment resume " + cli::shell_word(run.stem));
  return report.add("next", "tactograph experiment prove " + cli::shell_word(run.stem));
}

// What a file of answers asked for, and the nearest setting, which was accepted.
std::vector<Report> settings_of(const Run& run,
                                const std::function<std::optional<double>(std::size_t)>& wanted) {
  std::vector<Report> rows;
  std::size_t answers = 0;
  for (const Attempt& attempt : run.queue.attempts()) {
    if (!attempt.answered) continue;
    const auto asked = wanted(answers++), accepted = accepted_ratio(attempt);
    if (!asked || !accepted) continue;
    rows.emplace_back().add("attempt", attempt.begun.attempt);
    rows.back().add("asked_ratio", *asked).add("accepted_ratio", *accepted);
  }
  return rows;
}

// Calls `work` with what a run needs from outside. `protocol` belongs to the study.
template <class Work>
Result<Report> with_participant(const RunStudyOptions& o, const schema::Protocol& protocol, bool simulated,
                                const Work& work) {
  const cli::StopSignals signals;
  RunRequest request;
  request.device_uri = o.device;
  request.masking_level_db = o.masking_level_db;
  const std::function<bool()> stop_asked = [&] { return signals.stop_asked(); };
  request.stop_asked = stop_asked;
  std::optional<ParticipantScreen> screen;
  if (!o.answers.empty()) {
    auto participant = answers_from(o.answers, protocol);
    TACTO_TRY(participant);
    request.participant = std::move(*participant);
  } else if (!simulated) {
    auto texts = schema::texts_in(protocol, o.language);
    TACTO_TRY(texts);
    screen.emplace(protocol, std::move(*texts), stop_asked);
    TACTO_TRY(screen->check_terminal());
    request.participant = screen->participant();
    request.language = o.language;
    if (protocol.masking_noise && !o.masking_level_db)
      cli::warn("the level of the masking noise is not measured: --masking-level checks and logs it");
  }
  std::optional<cli::Progress> progress;
  if (!screen) progress.emplace("trials");
  request.tell = [&](double part) {
    if (progress) progress->update(part);
  };
  const auto wanted = request.participant.wanted;
  auto run = work(std::move(request));
  TACTO_TRY(run);
  if (screen && run->queue.has_ended()) screen->show_end();
  Report report = report_of_run(*run);
  if (wanted && protocol.task == schema::Task::adjustment) report.add("settings", settings_of(*run, wanted));
  return report;
}

Result<Report> run_run_study(const RunStudyOptions& o) {
  std::optional<Observer> observer;
  if (!o.observer.empty()) {
    auto parsed = parse_observer(o.observer);
    TACTO_TRY(parsed);
    observer = std::move(*parsed);
  }
  const auto protocol = schema::read_protocol(o.what);
  TACTO_TRY(protocol);
  return with_participant(o, *protocol, observer.has_value(), [&](RunRequest request) {
    request.observer = observer;
    return begin_run(o.what, o.participant, request);
  });
}

Result<Report> run_resume_study(RunStudyOptions o) {
  const auto run = read_run(o.what);
  TACTO_TRY(run);
  if (!run->journal.plan.language.empty()) o.language = run->journal.plan.language;
  const bool simulated = !run->journal.plan.observer.empty();
  if (simulated && !o.answers.empty())
    return schema::fail(ErrorKind::usage, "an observer answers in this run", "--answers", "leave it out");
  return with_participant(o, run->study.protocol, simulated,
                          [&](RunRequest request) { return resume_run(o.what, std::move(request)); });
}

std::string proof_in_words(const Proof& proof, const TrialQueue& queue, schema::Task task) {
  std::string words = fmt::format("{} of {} trials delivered", proof.delivered, proof.trials);
  if (proof.placed > 0 && task == schema::Task::fidelity)
    words += fmt::format(", beside real samples, of whose {} placements there is only the operator's word",
                         proof.placed);
  else if (proof.placed > 0)
    words += fmt::format(", {} with real samples, of which there is only the operator's word", proof.placed);
  if (queue.abandoned() > 0)
    words += fmt::format(", {} abandoned after too many attempts that were not delivered", queue.abandoned());
  if (queue.timed_out() > 0)
    words += fmt::format("; {} more were left out by the time limit of a block", queue.timed_out());
  if (proof.stretch_error)
    words += fmt::format("; predicted stretch within {:.2g} of the nominal one", *proof.stretch_error);
  if (proof.ratio_error)
    words += fmt::format("; predicted ratio within {:.2g} of the {} one", *proof.ratio_error,
                         task == schema::Task::adjustment ? "accepted" : "asked");
  words += fmt::format("; {} of {} sessions the same to the bit", proof.same_to_the_bit, proof.sessions);
  if (proof.same_until_lost > 0)
    words += fmt::format(", {} not delivered ones up to the first lost tick", proof.same_until_lost);
  return words;
}

struct ProveOptions {
  std::string name, protocol;
};

std::string limits_in_words(const schema::DeliveryLimits& limits) {
  const auto speed = [](double value_mps) { return schema::for_people(value_mps, schema::Dimension::speed); };
  return fmt::format(
      "at most {} lost ticks, {} in fault, {} late, {} blind; removed by limits {:g} dB; error of each whole "
      "stroke {:g} dB; strokes at {} to {}",
      limits.lost_ticks, limits.fault_ticks, limits.late_ticks, limits.blind_ticks,
      limits.removed_by_limits_db, limits.error_db, speed(limits.slowest_mps), speed(limits.fastest_mps));
}

Report interval_row(const MarkedInterval& interval) {
  const schema::IntervalFacts& facts = interval.facts;
  Report row;
  row.add("mark", interval.mark).add("from_s", interval.from_s).add("to_s", interval.to_s);
  row.add("delivered", interval.delivered == Delivered::yes  ? "yes"
                       : interval.delivered == Delivered::no ? "no"
                                                             : "unknown");
  row.add("strokes", facts.strokes);
  if (facts.strokes > 0) row.add("slowest_mps", facts.slowest_mps).add("fastest_mps", facts.fastest_mps);
  if (facts.predicted_error_db) row.add("predicted_error_db", *facts.predicted_error_db);
  if (facts.measured_error_db) row.add("measured_error_db", *facts.measured_error_db);
  if (facts.removed_by_limits_db) row.add("removed_by_limits_db", *facts.removed_by_limits_db);
  row.add("ticks", facts.ticks).add("lost_ticks", facts.lost_ticks).add("fault_ticks", facts.fault_ticks);
  row.add("late_ticks", facts.late_ticks).add("blind_ticks", facts.blind_ticks);
  return row.add("why", fmt::format("{}", fmt::join(interval.why, "; ")));
}

Result<Report> run_prove_marks(const ProveOptions& o) {
  schema::DeliveryLimits limits = stretch_protocol("1").delivered;
  if (!o.protocol.empty()) {
    const auto protocol = schema::read_protocol(o.protocol);
    TACTO_TRY(protocol);
    limits = protocol->delivered;
  }
  cli::Progress progress("proving");
  const auto proof = prove_marks(o.name, limits, [&](double part) { progress.update(part); });
  TACTO_TRY(proof);
  const auto delivered = std::ranges::count(proof->intervals, Delivered::yes, &MarkedInterval::delivered);
  Report report;
  report
      .add("verdict",
           fmt::format("{} of {} marked intervals delivered; the session is {} to the bit", delivered,
                       proof->intervals.size(), proof->same_to_the_bit ? "the same" : "not the same"))
      .add("same_to_the_bit", proof->same_to_the_bit);
  report.add("marked_intervals", proof->intervals.size())
      .add("delivered", static_cast<std::size_t>(delivered));
  report.add("limits", limits_in_words(limits));
  report.add("recorded", "ticks and drive").add("predicted", "displacement, by the transducer's model");
  if (!proof->simulated.empty()) report.add("simulated", proof->simulated);
  std::vector<Report> rows;
  for (const MarkedInterval& interval : proof->intervals) rows.push_back(interval_row(interval));
  report.add("intervals", std::move(rows));
  return proof->same_to_the_bit ? report : report.ends_with(ErrorKind::unsuitable);
}

Result<Report> run_prove_run(const ProveOptions& o) {
  if (names_session(o.name)) return run_prove_marks(o);
  const std::string& name = o.name;
  if (!o.protocol.empty())
    return schema::fail(ErrorKind::usage, "the limits of a run are those of its study", "--protocol",
                        "leave it out");
  const auto run = read_run(name);
  TACTO_TRY(run);
  cli::Progress progress("proving");
  const Proof proof = prove(*run, [&](double part) { progress.update(part); });
  Report report;
  report.add("verdict", proof_in_words(proof, run->queue, run->study.protocol.task))
      .add("proven", proof.holds());
  report.add("complete", run->queue.has_ended())
      .add("trials", proof.trials)
      .add("delivered", proof.delivered);
  report.add("attempts", proof.attempts)
      .add("not_delivered", proof.failed)
      .add("interrupted", proof.interrupted)
      .add("sessions", proof.sessions)
      .add("same_to_the_bit", proof.same_to_the_bit);
  add_lost_trials(report, run->queue);
  if (run->study.protocol.task == schema::Task::identification ||
      run->study.protocol.task == schema::Task::fidelity)
    report.add("real_samples", proof.placed);
  if (proof.stretch_error) report.add("stretch_error", *proof.stretch_error);
  if (proof.ratio_error) report.add("ratio_error", *proof.ratio_error);
  if (proof.measured_stretch_error) report.add("measured_stretch_error", *proof.measured_stretch_error);
  if (proof.measured_ratio_error) report.add("measured_ratio_error", *proof.measured_ratio_error);
  report.add("recorded", "ticks and drive").add("predicted", "displacement, by the transducer's model");
  if (!proof.simulated.empty()) report.add("simulated", proof.simulated);
  if (run->study.protocol.masking_noise) report.add("masking_noise", noise_of_run(*run));
  if (run->study.protocol.normal_force)
    report.add("normal_force",
               force_in_words(run->study.protocol.normal_force) + "; not proven: no session records it");
  if (!run->journal.plan.observer.empty()) report.add("observer", observer_in_words(*run));
  if (!proof.faults.empty()) report.add("faults", proof.faults);
  if (proof.holds() && run->queue.has_ended())
    report.add("next", "tactograph experiment analyse " + cli::shell_word(run->study.stem));
  return proof.holds() ? report : report.ends_with(ErrorKind::unsuitable);
}

struct NoiseOptions {
  std::string study, output;
  schema::Existing existing = schema::Existing::keep;
};

Result<Report> run_noise(const NoiseOptions& o) {
  const auto protocol = schema::read_protocol(o.study);
  TACTO_TRY(protocol);
  if (!protocol->masking_noise)
    return schema::fail(ErrorKind::unsuitable, "the protocol has no masking noise", o.study,
                        "add masking_noise to it, or make it with --masking-noise 65dB");
  if (!o.output.ends_with(".wav"))
    return schema::fail(ErrorKind::usage, "does not end in .wav", o.output, "name a WAV file");
  TACTO_TRY(write_masking_noise(o.output, *protocol->masking_noise, protocol->seed, o.existing));
  Report report;
  report.add("masking_noise", noise_in_words(protocol->masking_noise));
  report.add("duration_s", kNoisePeriodS).add("rms_db_re_full_scale", kNoiseRmsDb);
  report.add("level_at_the_ear", "not measured: it depends on the volume and the headphones");
  report.add("written", std::vector<std::string>{o.output});
  return report.add("next",
                    "play it repeatedly, measure its level at the ear, and give that to 'run "
                    "--masking-level'");
}

struct WatchOptions {
  std::string study;
  std::optional<double> time_s;
};

std::string progress_in_words(const std::string& stem, const TrialQueue& queue) {
  return fmt::format("{}: {} of {} trials, {} attempts{}\n", stem, queue.counted(), queue.trials(),
                     queue.tried(), queue.has_ended() ? ", complete" : "");
}

Result<Report> run_watch_study(const WatchOptions& o) {
  constexpr auto kLookEvery = std::chrono::milliseconds(500);
  const auto study = read_study(o.study);
  TACTO_TRY(study);
  const cli::StopSignals signals;
  const auto begun = std::chrono::steady_clock::now();
  std::map<std::string, std::string> shown;
  while (true) {
    bool going_on = false;
    std::vector<Report> rows;
    for (const std::string& stem : runs_of(*study)) {
      const auto journal = schema::read_journal(schema::journal_path(stem));
      if (!journal && journal.error().kind == ErrorKind::unsuitable)
        continue;  // its first line is being written
      TACTO_TRY(journal);
      const auto queue = queue_of(*journal, study->protocol, study->key);
      TACTO_TRY(queue);
      going_on = going_on || !queue->has_ended();
      rows.push_back(progress_row(stem, *queue));
      const std::string line = progress_in_words(stem, *queue);
      if (std::exchange(shown[stem], line) != line) cli::write_message(line);
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begun;
    const bool may_begin = rows.empty() && o.time_s;
    if ((!going_on && !may_begin) || signals.stop_asked() || (o.time_s && elapsed.count() >= *o.time_s))
      return Report().add("study", study->stem).add("runs", std::move(rows));
    std::this_thread::sleep_for(kLookEvery);
  }
}

struct PowerOptions {
  std::string study;
  std::vector<std::string> weber;
  PowerAssumptions assumed;
};

// "8 people (86.3 %; 7: 79.9 %)": the fewest for the goal with their power, and that of one fewer; rounded
// down, so that none below the goal is printed as the goal.
std::string people_in_words(const std::vector<StudyPower::Row>& rows, const std::optional<int>& people,
                            double StudyPower::Row::*power) {
  if (!people) return fmt::format("more than {} people", kMostPeople);
  const auto percent = [&](const StudyPower::Row& row) { return std::floor(1000 * row.*power) / 10; };
  const auto row = std::ranges::find(rows, *people, &StudyPower::Row::people);
  const std::string fewer =
      row == rows.begin() ? ""
                          : fmt::format("; {}: {:.1f} %", std::prev(row)->people, percent(*std::prev(row)));
  return fmt::format("{} people ({:.1f} %{})", *people, percent(*row), fewer);
}

Result<Report> run_study_power(PowerOptions o) {
  if (o.weber.size() != 2)
    return schema::fail(ErrorKind::usage, "needs two Weber fractions", "--weber",
                        "give for example 15.5%,25.3%");
  for (std::size_t i = 0; i < 2; ++i) {
    const auto weber = schema::parse_quantity(o.weber[i], schema::Dimension::share);
    if (!weber) return schema::fail(ErrorKind::usage, weber.error().what, "--weber", weber.error().remedy);
    o.assumed.weber[i] = *weber;
  }
  const auto protocol = schema::read_protocol(o.study);
  TACTO_TRY(protocol);
  cli::Progress progress("simulating people");
  const auto power = study_power(*protocol, o.assumed, [&](double part) { progress.update(part); });
  TACTO_TRY(power);
  Report report;
  report.add(
      "verdict",
      fmt::format("for a power of {:g} %: {} in each of two groups, or {} in both conditions",
                  100 * kPowerGoal, people_in_words(power->rows, power->a_group, &StudyPower::Row::groups),
                  people_in_words(power->rows, power->twice, &StudyPower::Row::twice)));
  if (power->a_group) report.add("people_a_group", *power->a_group);
  if (power->twice) report.add("people_twice", *power->twice);
  report.add(
      "assumed",
      fmt::format(
          "Weber fractions {:g} % and {:g} %; people scatter by {:g} % (standard deviation of ln W, the same "
          "factor in both conditions); {:g} % of the answers by chance, and a fit {} lapses; {} levels, {} "
          "times each; Student's t test of ln W over people, 5 %, two-sided",
          100 * o.assumed.weber[0], 100 * o.assumed.weber[1], 100 * o.assumed.spread,
          100 * o.assumed.lapse.value_or(0), o.assumed.lapse ? "with" : "without", protocol->levels.size(),
          protocol->repetitions));
  report.add("simulated", fmt::format("{} people, seed {}; {} of them can't be fitted and are left out",
                                      kSimulatedPeople, o.assumed.seed, power->unfitted));
  for (std::size_t i = 0; i < 2; ++i)
    report.add(fmt::format("fitted_weber_{}", i + 1), power->weber[i])
        .add(fmt::format("fitted_spread_{}", i + 1), power->spread[i]);
  report.add("fitted_spread_of_difference", power->spread_of_difference);
  std::vector<Report> rows;
  for (const StudyPower::Row& row : power->rows)
    rows.push_back(Report()
                       .add("people", row.people)
                       .add("power_of_groups", row.groups)
                       .add("power_of_twice", row.twice));
  return report.add("powers", std::move(rows));
}

struct ExportOptions {
  std::string study, folder;
  bool unblind = false;
  schema::Existing existing = schema::Existing::keep;
};

Result<Report> run_export_study(const ExportOptions& o) {
  const auto files = export_study(o.study, o.folder, o.unblind, o.existing);
  TACTO_TRY(files);
  Report report;
  report.add("written", *files);
  const std::string script = o.folder + "/analysis.R";
  if (std::ranges::find(*files, script) != files->end()) report.add("next", "Rscript " + script);
  return report;
}

struct WithdrawOptions {
  std::string study, participant;
  bool yes = false;
};

// Asks on a terminal; elsewhere the answer is no.
bool is_confirmed(const Withdrawal& withdrawal) {
  if (isatty(STDIN_FILENO) != 1 || isatty(STDERR_FILENO) != 1) return false;
  cli::write_message(fmt::format("{}\nType {} to delete these {} files: ", fmt::join(withdrawal.files, "\n"),
                                 withdrawal.participant, withdrawal.files.size()));
  std::string line;
  std::getline(std::cin, line);
  return line == withdrawal.participant;
}

Result<Report> run_withdraw(const WithdrawOptions& o) {
  const auto withdrawal = plan_withdrawal(o.study, o.participant);
  TACTO_TRY(withdrawal);
  const bool yes = o.yes || is_confirmed(*withdrawal);
  if (yes) TACTO_TRY(withdraw(*withdrawal));
  Report report;
  report.add("participant", o.participant).add("withdrawn", yes);
  report.add(yes ? "deleted" : "to_be_deleted", withdrawal->files);
  if (!withdrawal->outside.empty()) {
    report.add("outside_the_study", withdrawal->outside);
    cli::warn("files outside the study's folder are not deleted: delete them yourself");
  }
  const Leftovers left = find_leftovers(*withdrawal);
  if (!left.paths.empty()) {
    report.add("not_deleted", left.paths);
    cli::warn(
        fmt::format("files or folders with the code {} in the study's folder are not deleted: look yourself",
                    o.participant));
  }
  if (!left.complete)
    cli::warn(fmt::format("the study's folder was not searched completely for the code {}: look yourself",
                          o.participant));
  if (yes) return report;
  report.add("next", fmt::format("tactograph experiment withdraw {} --participant {} --yes", withdrawal->stem,
                                 o.participant));
  return report.ends_with(ErrorKind::usage);
}

}  // namespace

cli::Action declare_new_study(CLI::App& app) {
  auto options = std::make_shared<NewStudyOptions>();
  app.add_option(
         "PROTOCOL", options->what,
         "stretch or identification: experiments 2 and 1 of Wiertlewski 2011; fidelity: its comparison "
         "bench; amplitude: after Fiene "
         "and Kuchenbecker 2007; ordering, adjustment: after Minsky et al. 1990")
      ->required();
  app.add_option("-o,--output", options->stem, "Stem of the study's files; default: the protocol's name");
  app.add_option(
         "--textures", options->textures,
         "Textures of force. Of identification: the standards, A,B,C,D,E; of fidelity: those that are "
         "played beside each sample; of ordering: those that are put in order; of amplitude and adjustment: "
         "one")
      ->delimiter(',');
  cli::add_choice<schema::LevelMethod>(
      app, "--method", options->method,
      {{"constant", schema::LevelMethod::constant},
       {"staircase", schema::LevelMethod::staircase},
       {"quest_plus", schema::LevelMethod::quest_plus}},
      "Of stretch: each level equally often, or 60 trials whose levels follow "
      "the answers");
  app.add_option(
         "--intended", options->intended,
         "Of ordering: the parameter by which the textures were made, a number for each, in their order; "
         "'analyse' compares the answers with it")
      ->delimiter(',');
  cli::add_choice<schema::Goal>(
      app, "--goal", options->goal,
      {{"least", schema::Goal::least}, {"greatest", schema::Goal::greatest}, {"match", schema::Goal::match}},
      "Of adjustment: the least or the greatest gain at which it still is a texture, or that at which it is "
      "as "
      "strong as a reference");
  app.add_option("--reference", options->reference,
                 "Of adjustment, --goal match: the texture that is played before it; default: itself");
  app.add_option("--comparisons", options->comparisons,
                 "Of identification: which of them are presented, C,D,E; default: all")
      ->delimiter(',');
  app.add_option("--seed", options->seed, "Seed of codes and order: letters and digits");
  cli::add_quantity(app, "--masking-noise", options->masking_db, schema::Dimension::level,
                    "Level of masking noise at the ear, 65dB (re 20 uPa): 15-1500 Hz, within 3 dB; default: "
                    "the protocol has none");
  app.add_flag("--pacing-cue", options->pacing_cue,
               "The participant's screen shows a mark that moves as the finger is to move");
  app.add_option(
         "--normal-force", options->normal_force,
         "The participant's screen says whether the normal force, as the device reports it, is below, "
         "within or above this range: 0.3N,0.8N")
      ->delimiter(',');
  app.footer(
      "stretch: which of two sinusoids has the smaller period. identification: which of the standards is a "
      "comparison, a real sample in one block and played in the other one, each of 100 trials or 15 "
      "minutes. fidelity: each texture is played beside the real sample of each; the same or different. "
      "amplitude: one texture at gains between 0 and 2 times that of the real sample, which is "
      "before "
      "the participant; each is rated from -3 to 3 against it. ordering: all textures are explored freely, "
      "and "
      "put in order of roughness. adjustment: the gain of a texture is changed by keys while it is played, "
      "from a low start in odd trials and from a high one in even trials, until it is accepted. "
      "Label the real samples with the codes of STUDY.key.json, which neither operator nor participant "
      "reads.");
  cli::declare_force(app, options->existing);
  return [options, &app]() -> Result<Report> {
    std::vector<std::string> given;
    for (const char* const name :
         {"--textures", "--comparisons", "--intended", "--goal", "--reference", "--method"})
      if (app.count(name) > 0) given.emplace_back(name);
    TACTO_TRY(check_new_options(*options, given));
    return run_new_study(*options);
  };
}

cli::Action declare_check_study(CLI::App& app) {
  auto options = std::make_shared<CheckStudyOptions>();
  app.add_option("STUDY", options->study, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("-d,--device", options->device,
                 "Check also that this device can play each stimulus, and has each of them loaded within the "
                 "protocol's lead; a warning if the lead is below twice the slowest load");
  app.footer(
      "Refused are: unknown members, texts that are missing, keys with two meanings, stimuli that are not "
      "those "
      "of the key; with a device also a stimulus that it cannot play. A band of playback that loses much of "
      "a "
      "stimulus at an accepted speed is a warning. 'run' checks the same.");
  return [options] { return run_check_study(*options); };
}

namespace {

void declare_masking_level(CLI::App& app, RunStudyOptions& options) {
  cli::add_quantity(
      app, "--masking-level", options.masking_level_db, schema::Dimension::level,
      "Level of the masking noise at the ear, as measured now with a sound level meter: compared "
      "with the protocol, and kept in the journal; default: not measured");
}

}  // namespace

cli::Action declare_run_study(CLI::App& app) {
  auto options = std::make_shared<RunStudyOptions>();
  app.add_option("STUDY", options->what, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("-d,--device", options->device, kDeviceHelp)->required();
  app.add_option("--participant", options->participant, "Code of the participant, such as P07")->required();
  CLI::Option* observer = app.add_option(
      "--observer", options->observer,
      "A simulated participant, which gets only the displacement that the sessions predict: "
      "weber=25.3%,lapse=2%,hurry=5%,seed=1 (hurry: share of trials with a finger of twice the fastest "
      "accepted speed). Of an "
      "identification or fidelity: template,noise=9dB,hurry=5%,seed=1, which compares its spectrum with the "
      "standards'; "
      "its noise is tuned, so its success says nothing about people. Of amplitude: "
      "match=86%,weber=10%,lapse=2%,seed=1 "
      "(match: the ratio that seems equal to the real sample). Of ordering: order,noise=1dB,seed=1, by the "
      "RMS "
      "of the displacement. Of adjustment: threshold=20%,sd=10%,hysteresis=5%,hurry=5%,seed=1, the ratio "
      "that it "
      "looks "
      "for, the standard deviation of its logarithm, and the difference of descending series");
  CLI::Option* answers = app.add_option("--answers", options->answers, kAnswersHelp)->excludes(observer);
  app.add_option("--language", options->language, "Language of the screen, one of the protocol's texts")
      ->capture_default_str()
      ->excludes(observer)
      ->excludes(answers);
  declare_masking_level(app, *options);
  app.footer(
      "Each step is in STUDY-P07.trials.jsonl before the next one begins. Whether a trial was delivered is "
      "decided before its answer is read; what was not delivered comes again at the end. Ctrl-C ends the "
      "run; "
      "'resume' continues it, also after a crash.");
  return [options] { return run_run_study(*options); };
}

cli::Action declare_resume_study(CLI::App& app) {
  auto options = std::make_shared<RunStudyOptions>();
  app.add_option("RUN", options->what, "STUDY-P07, or its journal")->required();
  app.add_option("-d,--device", options->device, "Device; default: that of the run");
  app.add_option("--answers", options->answers, kAnswersHelp);
  declare_masking_level(app, *options);
  app.footer(
      "The trial that was interrupted is the next one again. The file of --answers holds all answers and "
      "labels of the run, from its first trial on: those that the run has are not read again.");
  return [options] { return run_resume_study(*options); };
}

cli::Action declare_prove_run(CLI::App& app) {
  auto options = std::make_shared<ProveOptions>();
  app.add_option("RUN", options->name, "STUDY-P07, or its journal; or a session with marks of any client")
      ->required();
  app.add_option("--protocol", options->protocol,
                 "Of a session: the limits of this protocol; default: those of 'new stretch'");
  app.footer(
      "Decides again from the sessions what was delivered, and computes each session's drive again. Proven "
      "are ticks and drive; the displacement is predicted by the transducer's model, and the normal force "
      "is "
      "in no session. Exit code 5: not proven.\n"
      "Of a session it judges each interval from a mark ('ctl mark TEXT') to the next one, or to the end of "
      "the session; after the mark 'end' there is no interval until the next mark. Exit code 5: the drive, "
      "computed again, is not the same to the bit. Exit code 0 does not say that an interval was delivered: "
      "see 'delivered' (yes, no, unknown) of each interval.");
  return [options] { return run_prove_run(*options); };
}

cli::Action declare_noise(CLI::App& app) {
  auto options = std::make_shared<NoiseOptions>();
  app.add_option("STUDY", options->study, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("-o,--output", options->output, "WAV file")->required();
  cli::declare_force(app, options->existing);
  app.footer(
      "White noise in the band of the protocol's masking_noise, one channel, 48 kHz, 30 s, which repeats "
      "without a seam. It is for the participant's headphones, because a bender that plays 15-500 Hz can be "
      "heard. No part of tactograph plays it or measures its level.");
  return [options] { return run_noise(*options); };
}

cli::Action declare_watch_study(CLI::App& app) {
  auto options = std::make_shared<WatchOptions>();
  app.add_option("STUDY", options->study, "Stem of the study, or STUDY.protocol.json")->required();
  cli::add_quantity(app, "--time", options->time_s, schema::Dimension::time,
                    "Duration; default: until no run of the study is going on, or Ctrl-C");
  app.footer(
      "A line for each run whenever its journal grows: how many of its trials are delivered and answered. An "
      "interrupted run counts as going on. Nothing tells which stimuli they were.");
  return [options] { return run_watch_study(*options); };
}

cli::Action declare_study_power(CLI::App& app) {
  auto options = std::make_shared<PowerOptions>();
  app.add_option("STUDY", options->study, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("--weber", options->weber, "Weber fractions of the two conditions: 15.5%,25.3%")
      ->required()
      ->delimiter(',');
  cli::add_quantity(app, "--spread", options->assumed.spread, schema::Dimension::share,
                    "How much people differ: standard deviation of ln W")
      ->required();
  cli::add_quantity(
      app, "--lapse", options->assumed.lapse, schema::Dimension::share,
      "Share of answers by chance, which the fit then estimates; default: none, and a fit without "
      "lapses");
  app.add_option("--seed", options->assumed.seed, "Seed of the simulated people")->capture_default_str();
  app.footer(
      "People are simulated with the levels and repetitions of the protocol, and fitted as 'analyse' does; "
      "the power is "
      "the share of simulated studies in which Student's t test of ln W finds the difference. Lapses that "
      "have to be "
      "fitted cost power: try --lapse 2%.");
  return [options] { return run_study_power(*options); };
}

cli::Action declare_export_study(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  app.add_option("STUDY", options->study, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("-o,--output", options->folder, "Folder of the export")->required();
  app.add_flag("--unblind", options->unblind,
               "Export before the planned participants are complete; STUDY.unblinded.txt keeps the date");
  cli::declare_force(app, options->existing);
  app.footer(
      "trials.csv has a row for each attempt of all participants; analysis.R (of two intervals) fits a "
      "generalised linear mixed "
      "model "
      "(probit) to it with lme4, and to other tables: its first lines say how. The folder is a data set "
      "after BIDS: "
      "participants.tsv, sub-P07/beh/sub-P07_task-STUDY_beh.tsv and .json.");
  return [options] { return run_export_study(*options); };
}

cli::Action declare_withdraw(CLI::App& app) {
  auto options = std::make_shared<WithdrawOptions>();
  app.add_option("STUDY", options->study, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("--participant", options->participant, "Code of the participant, such as P07")->required();
  app.add_flag("--yes", options->yes, "Delete without a question");
  app.footer(
      "Deletes journal, table and sessions of the participant, and the outputs of 'analyse' and 'export' in "
      "the study's folder, which can be made again without this participant. A symbolic link among them is "
      "refused before anything is deleted.\nSTUDY.withdrawn.txt keeps the code and the date. If it is "
      "interrupted, repeat it. What else in the study's folder has the code in its name (sub-P07, "
      "STUDY-P07), or as a word in a csv, tsv or json file of at most 4 MB, is named and not deleted.");
  return [options] { return run_withdraw(*options); };
}

}  // namespace tacto::analysis
