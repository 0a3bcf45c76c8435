// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/experiment_study.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "analysis/cli/participant_screen.hpp"
#include "analysis/experiment/interval_play.hpp"
#include "analysis/experiment/study_run.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

struct NewStudyOptions {
  std::string what, stem, seed = "1";
  schema::Existing existing = schema::Existing::keep;
};

struct CheckStudyOptions {
  std::string study, device;
};

struct RunStudyOptions {
  std::string what;  ///< the study, or the run to be resumed
  std::string device, participant, observer, answers;
};

constexpr const char* kDeviceHelp =
    "Device: usb:, sim: ... (as of 'play'; an emulated finger moves at the protocol's pace)";
constexpr const char* kAnswersHelp =
    "File with an answer on each line, its word or its key; default: the keys of this terminal";

Report study_report(const Study& study) {
  const schema::Protocol& protocol = study.protocol;
  Report report;
  report.add("study", study.stem)
      .add("levels", protocol.levels.size())
      .add("repetitions", protocol.repetitions)
      .add("trials", protocol.levels.size() * static_cast<std::size_t>(protocol.repetitions));
  return report.add("interval_s", paced_path(protocol.pace).duration_s());
}

Result<Report> warn_and_report(const Study& study) {
  const auto notes = lost_band(study);
  TACTO_TRY(notes);
  for (const std::string& note : *notes) cli::warn(note);
  return study_report(study);
}

Result<Report> run_new_study(const NewStudyOptions& o) {
  if (o.what != "stretch")
    return schema::fail(ErrorKind::usage,
                        fmt::format("'{}' is not a protocol that comes with tactograph", o.what),
                        "experiment new", "there is one: stretch");
  const auto study = write_study(o.stem.empty() ? o.what : o.stem, stretch_protocol(o.seed), o.existing);
  TACTO_TRY(study);
  auto report = warn_and_report(*study);
  TACTO_TRY(report);
  return report->add("written", std::vector<std::string>{schema::protocol_path(study->stem),
                                                         schema::key_path(study->stem), study->stem + "/"});
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
  report->add("lead_s", study->protocol.lead_s);
  if (!slowest)
    report->add("slowest_load", "not measured: no device is named");
  else if (slowest->code.empty())
    report->add("slowest_load", "not measured: this device does not keep time");
  else
    report->add("slowest_load_s", slowest->time_s);
  return report->add("valid", true);
}

// Counts only: no screen names a stimulus.
Report report_of_run(const Run& run) {
  Report report;
  report.add("run", run.stem).add("complete", run.queue.has_ended());
  report.add("trials", run.queue.trials()).add("delivered_and_answered", run.queue.counted());
  report.add("attempts", run.queue.attempts().size());
  if (!run.journal.plan.observer.empty()) report.add("simulated", "observer " + run.journal.plan.observer);
  std::vector<std::string> written = {schema::journal_path(run.stem), run.stem + "/"};
  if (run.queue.has_ended()) written.push_back(run.stem + ".trials.tsv");
  report.add("written", written);
  if (!run.queue.has_ended()) return report.add("next", "tactograph experiment resume " + run.stem);
  return report.add("next", "tactograph experiment prove " + run.stem);
}

// Calls `work` with what a run needs from outside. `protocol` belongs to the study.
template <class Work>
Result<Report> with_participant(const RunStudyOptions& o, const schema::Protocol& protocol, bool simulated,
                                const Work& work) {
  const cli::StopSignals signals;
  RunRequest request;
  request.device_uri = o.device;
  const std::function<bool()> stop_asked = [&] { return signals.stop_asked(); };
  request.stop_asked = stop_asked;
  std::optional<ParticipantScreen> screen;
  if (!o.answers.empty()) {
    auto participant = answers_from(o.answers, protocol);
    TACTO_TRY(participant);
    request.participant = std::move(*participant);
  } else if (!simulated) {
    screen.emplace(protocol, stop_asked);
    TACTO_TRY(screen->check_terminal());
    request.participant = screen->participant();
  }
  std::optional<cli::Progress> progress;
  if (!screen) progress.emplace("trials");
  request.tell = [&](double part) {
    if (progress) progress->update(part);
  };
  auto run = work(std::move(request));
  TACTO_TRY(run);
  if (screen && run->queue.has_ended()) screen->show_end();
  return report_of_run(*run);
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

Result<Report> run_resume_study(const RunStudyOptions& o) {
  const auto run = read_run(o.what);
  TACTO_TRY(run);
  const bool simulated = !run->journal.plan.observer.empty();
  if (simulated && !o.answers.empty())
    return schema::fail(ErrorKind::usage, "an observer answers in this run", "--answers", "leave it out");
  return with_participant(o, run->study.protocol, simulated,
                          [&](RunRequest request) { return resume_run(o.what, std::move(request)); });
}

std::string proof_in_words(const Proof& proof) {
  return fmt::format(
      "{} of {} trials delivered; predicted stretch within {:.2g} of the nominal one; {} of {} "
      "sessions the same to the bit",
      proof.delivered, proof.trials, proof.stretch_error, proof.same_to_the_bit, proof.sessions);
}

Result<Report> run_prove_run(const std::string& name) {
  const auto run = read_run(name);
  TACTO_TRY(run);
  cli::Progress progress("proving");
  const Proof proof = prove(*run, [&](double part) { progress.update(part); });
  Report report;
  report.add("verdict", proof_in_words(proof)).add("proven", proof.holds());
  report.add("complete", run->queue.has_ended())
      .add("trials", proof.trials)
      .add("delivered", proof.delivered);
  report.add("attempts", proof.attempts)
      .add("not_delivered", proof.failed)
      .add("interrupted", proof.interrupted)
      .add("sessions", proof.sessions)
      .add("same_to_the_bit", proof.same_to_the_bit)
      .add("stretch_error", proof.stretch_error);
  report.add("recorded", "ticks and drive").add("predicted", "displacement, by the transducer's model");
  if (!proof.simulated.empty()) report.add("simulated", proof.simulated);
  if (!run->journal.plan.observer.empty()) report.add("observer", run->journal.plan.observer);
  if (!proof.faults.empty()) report.add("faults", proof.faults);
  return proof.holds() ? report : report.ends_with(ErrorKind::unsuitable);
}

}  // namespace

cli::Action declare_new_study(CLI::App& app) {
  auto options = std::make_shared<NewStudyOptions>();
  app.add_option("PROTOCOL", options->what, "stretch: experiment 2 of Wiertlewski 2011")->required();
  app.add_option("-o,--output", options->stem, "Stem of the study's files; default: the protocol's name");
  app.add_option("--seed", options->seed, "Seed of codes and order: letters and digits");
  cli::declare_force(app, options->existing);
  return [options] { return run_new_study(*options); };
}

cli::Action declare_check_study(CLI::App& app) {
  auto options = std::make_shared<CheckStudyOptions>();
  app.add_option("STUDY", options->study, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("-d,--device", options->device,
                 "Check also that this device can play each stimulus, and has each of them loaded within the "
                 "protocol's lead");
  return [options] { return run_check_study(*options); };
}

cli::Action declare_run_study(CLI::App& app) {
  auto options = std::make_shared<RunStudyOptions>();
  app.add_option("STUDY", options->what, "Stem of the study, or STUDY.protocol.json")->required();
  app.add_option("-d,--device", options->device, kDeviceHelp)->required();
  app.add_option("--participant", options->participant, "Code of the participant, such as P07")->required();
  CLI::Option* observer = app.add_option(
      "--observer", options->observer,
      "A simulated participant, which gets only the displacement that the sessions predict: "
      "weber=25.3%,lapse=2%,hurry=5%,seed=1 (hurry: share of trials with a finger of twice the speed)");
  app.add_option("--answers", options->answers, kAnswersHelp)->excludes(observer);
  app.footer(
      "Each step is in STUDY-P07.trials.jsonl before the next one begins. Whether a trial was delivered is "
      "decided before its\nanswer is read; what was not delivered comes again at the end. Ctrl-C ends the "
      "run; "
      "'resume' continues it, also after a crash.");
  return [options] { return run_run_study(*options); };
}

cli::Action declare_resume_study(CLI::App& app) {
  auto options = std::make_shared<RunStudyOptions>();
  app.add_option("RUN", options->what, "STUDY-P07, or its journal")->required();
  app.add_option("-d,--device", options->device, "Device; default: that of the run");
  app.add_option("--answers", options->answers, kAnswersHelp);
  return [options] { return run_resume_study(*options); };
}

cli::Action declare_prove_run(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  app.add_option("RUN", *name, "STUDY-P07, or its journal")->required();
  app.footer(
      "Decides again from the sessions what was delivered, and computes each session's drive again. Proven "
      "are "
      "ticks and drive;\nthe displacement is predicted by the transducer's model, and the normal force is in "
      "no "
      "session. Exit code 5: not proven.");
  return [name] { return run_prove_run(*name); };
}

}  // namespace tacto::analysis
