// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/play.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "data-schema/command/output_options.hpp"
#include "data-schema/command/stop_signals.hpp"
#include "data-schema/report/choices_report.hpp"
#include "data-schema/report/pace.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/warnings.hpp"
#include "playback/cli/play_options.hpp"
#include "playback/cli/play_reports.hpp"
#include "playback/cli/scene_forces.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/player/session_name.hpp"
#include "playback/render/at_speed.hpp"
#include "playback/strokes/stroke_report.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Dimension;
using schema::Result;

namespace {

struct PlayVerbOptions {
  PlayOptions play;
  FingerPathOption path;
  std::optional<std::string> session;
  std::string script;
  AskedBudget budget;
  bool hold_stable = false;
  CLI::Option* rate = nullptr;
};

void declare_what(CLI::App& app, PlayOptions& o) {
  app.add_option("what", o.program.file, "Texture or scene: stem or file name")->required();
  app.add_option(
         "-d,--device", o.device_uri,
         "Device: usb:, comedi:NAME, sim:surface=C, sim:planar,device=sandpaper-1990,hand=minsky-radial ...")
      ->required();
  app.add_option("--transducer", o.transducer, "A preset or NAME.transducer.json; default: the device's own");
  cli::declare_unfit_transducer(app, o.program.unfit_transducer);
  cli::refuse_force(app);
  app.add_flag("--implausible", o.program.implausible,
               "Accept a transducer file with impossible numbers, for example a mass of 1e-12 kg");
  cli::add_quantity(
      app, "--time", o.time_s, Dimension::time,
      "Duration; default: that of the finger's path, or 10 s. After the path's end the finger rests");
}

void declare_texture(CLI::App& app, PlayOptions& o) {
  cli::add_quantity(app, "--at", o.program.at_m, Dimension::length,
                    "Of a texture: encoder position of its position 0");
  cli::add_gain(app, o.program.gain, "Gain: ", kDefaultGain);
  declare_ends(app, o.program.ends);
}

void declare_loop(CLI::App& app, PlayVerbOptions& verb) {
  PlayOptions& o = verb.play;
  verb.rate =
      cli::add_quantity(app, "--rate", o.prepare.rate_hz, Dimension::frequency, "Tick rate of the drive");
  cli::add_choice<bool>(app, "--loop", o.loop_here, {{"device", false}, {"host", true}},
                        "What closes the loop: the device, or the real-time thread of this computer (host)");
  app.add_flag("--no-watchdog", o.without_watchdog,
               "On comedi:, play without the watchdog of the wiring: the card keeps its last voltage if this "
               "program dies. The session keeps this option");
  app.add_flag_callback(
      "--no-look-ahead", [&o] { o.prepare.look_ahead = false; },
      "Read the texture at the finger's present position, without compensation of the inverse's delay");
  app.add_flag_callback(
      "--keep-hysteresis", [&o] { o.prepare.undo_hysteresis = false; },
      "Do not invert the hysteresis of the transducer's file");
  cli::add_quantity(app, "--onset", o.prepare.onset_s, Dimension::time, "Time in which the drive rises");
}

void add_played(Report& report, const PlayOutcome& outcome) {
  const TickView& ticks = outcome.status.ticks;
  report.add("ticks", outcome.recorder.ticks).add("lost_ticks", ticks.lost() + outcome.recorder.lost());
  report.add("late_ticks", ticks.late())
      .add("limited_ticks", ticks.limited())
      .add("energy_limited_ticks", ticks.energy_limited())
      .add("gated_ticks", ticks.gated())
      .add("blind_ticks", ticks.blind());
  add_removed(report, outcome.limits);
  if (ticks.limited() > 0)
    cli::warn(
        fmt::format("the drive was limited in {} of {} ticks and is weaker there than the texture: choose a "
                    "smaller --gain",
                    ticks.limited(), outcome.recorder.ticks));
  report.add("drive_peak_v", ticks.drive_peak_v());
  report.add("passes_to_hz", outcome.passes_to_hz).add("delay_left_s", outcome.delay_left_s);
  if (const auto& looped = outcome.looped)
    report.add("looked_ahead_s", looped->looked_ahead_s)
        .add("latency_p50_s", looped->latency.p50_s)
        .add("latency_p99_s", looped->latency.p99_s)
        .add("missed_ticks", looped->missed_ticks);
  report.add("inverse_error_db", outcome.inverse_error_db);
  cli::add_choices(report, outcome.choices);
}

// If the speed cannot be read, the verb `session` says why.
void add_power(Report& report, const std::string& session, const spatial::Band& band) {
  const auto speed = stroke_speed(session);
  if (!speed || !speed->power_kept_percent) return;
  report.add("mean_speed_mps", speed->mean_mps).add("power_kept_percent", *speed->power_kept_percent);
  if (*speed->power_kept_percent < kLeastPowerPercent)
    cli::warn(fmt::format("at {} the band of {} to {} keeps {:.3g} % of the texture's power",
                          schema::for_people(speed->mean_mps, Dimension::speed),
                          schema::for_people(band.low_hz, Dimension::frequency),
                          schema::for_people(band.high_hz, Dimension::frequency),
                          *speed->power_kept_percent));
}

Report add_end(Report report, const PlayOutcome& outcome) {
  if (!outcome.recorder.failure.empty()) {
    cli::warn(fmt::format("the session is incomplete, {} ticks are not in it: {}", outcome.recorder.lost(),
                          outcome.recorder.failure));
    report.ends_with(schema::ErrorKind::cannot_write);
  }
  if (outcome.status.state != PlayerState::fault) return report;
  cli::warn("playing ended in a fault: " + outcome.status.fault);
  report.add("fault", outcome.status.fault).ends_with(schema::ErrorKind::device);
  return report;
}

Report play_report(const PlayOptions& o, const PlayOutcome& outcome, const cli::Pace& pace, bool explain) {
  Report report;
  report.add("session", o.session).add("device", outcome.device);
  if (!outcome.simulated.empty()) report.add("simulated", outcome.simulated);
  add_gain(report, outcome.gain_m_per_n, outcome.default_gain_m_per_n);
  add_kept_gain(report, outcome.kept_gain);
  report.add("played_s", outcome.status.ticks.playing_s());
  if (outcome.rests_from_s) report.add("finger_rests_from_s", *outcome.rests_from_s);
  if (!outcome.real_time) pace.add_to(report, outcome.status.ticks.span_s());
  report.add("off_texture_percent", 100 * outcome.status.ticks.off_textures());
  add_loop(report, outcome.loop_period_m, outcome.loop_seam_m);
  add_power(report, o.session, {o.prepare.band.low_hz, outcome.passes_to_hz});
  add_played(report, outcome);
  if (outcome.decision) add_decision(report, *outcome.decision, explain);
  if (o.without_watchdog)
    cli::warn("played without a watchdog: a card keeps its last voltage if the program dies");
  cli::warn_grouped(outcome.notes);
  if (outcome.off_note) cli::warn(*outcome.off_note);
  return add_end(std::move(report), outcome);
}

Result<Report> run_play_forces(const PlayVerbOptions& asked) {
  const PlayOptions& o = asked.play;
  ForcePlayOptions play;
  play.program.file = o.program.file;
  if (asked.rate->count() > 0) play.program.rate_hz = o.prepare.rate_hz;
  play.program.onset_s = o.prepare.onset_s;
  play.program.hold_stable = asked.hold_stable;
  play.device_uri = o.device_uri;
  play.path = asked.path.file;
  play.script = asked.script;
  play.time_s = o.time_s;
  play.session = schema::session_path(asked.session.value_or(session_named_after(o.program.file)));
  const cli::StopSignals signals;
  cli::Progress progress("playing");
  const auto outcome = play_forces_once(
      play, [&] { return signals.stop_asked(); }, [&](double part) { progress.update(part); });
  TACTO_TRY(outcome);
  const TickView& ticks = outcome->status.ticks;
  Report report;
  report.add("session", play.session).add("device", outcome->device);
  if (!outcome->simulated.empty()) report.add("simulated", outcome->simulated);
  if (outcome->rests_from_s) report.add("finger_rests_from_s", *outcome->rests_from_s);
  report.add("rate_hz", ticks.rate_hz()).add("ticks", outcome->recorder.ticks);
  report.add("lost_ticks", ticks.lost() + outcome->recorder.lost());
  report.add("peak_limited_ticks", ticks.peak_limited())
      .add("slew_limited_ticks", ticks.slew_limited())
      .add("rms_limited_ticks", ticks.energy_limited())
      .add("force_peak_n", ticks.force_peak_n());
  if (asked.hold_stable) add_held(report, outcome->held, outcome->not_judged);
  cli::warn_grouped(outcome->notes);
  return add_end(std::move(report), *outcome);
}

Result<Report> run_play(const PlayVerbOptions& asked) {
  if (plays_forces(asked.play.program.file, asked.play.device_uri)) return run_play_forces(asked);
  const auto budget = asked.budget.budget();
  TACTO_TRY(budget);
  PlayOptions o = asked.play;
  o.program.budget = *budget;
  o.session = schema::session_path(asked.session.value_or(session_named_after(o.program.file)));
  if (!asked.path.file.empty()) {
    auto path = asked.path.read();
    TACTO_TRY(path);
    o.finger_path = std::move(*path);
  }
  const cli::StopSignals signals;
  const cli::Pace pace;
  cli::Progress progress("playing");
  const auto outcome = play_once(
      o, [&] { return signals.stop_asked(); }, [&](double part) { progress.update(part); });
  TACTO_TRY(outcome);
  return play_report(o, *outcome, pace, asked.budget.options.explain);
}

// The options of a tray have no effect on forces, nor a script on a tray: they are refused.
Result<void> check_scene_options(const CLI::App& app, const PlayVerbOptions& asked) {
  const PlayOptions& o = asked.play;
  if (plays_forces(o.program.file, o.device_uri))
    return check_force_options(
        app, {"device", "output", "finger-path", "time", "rate", "onset", "script", "hold-stable"});
  if (asked.script.empty() && !asked.hold_stable) return {};
  return schema::fail(
      schema::ErrorKind::usage,
      asked.hold_stable ? "--hold-stable is for a scene of forces" : "--script changes a scene of forces",
      o.program.file, "leave it out, or play a scene with force patches");
}

cli::Action declare_play(CLI::App& app) {
  auto options = std::make_shared<PlayVerbOptions>();
  declare_what(app, options->play);
  declare_finger_path(
      app, options->path,
      "Path of an emulated device's finger (on sim:planar of the hand, with a column for each axis, "
      "as in time_s,x_mm,y_mm): ");
  app.add_option(
      "-o,--output", options->session,
      "The session: NAME.session; default: the texture's name and the time of day, in this folder");
  app.add_option(
      "--script", options->script,
      "Changes of a scene of forces: a CSV with the columns time_s,command, where a command is 'set "
      "PATCH.LAYER.MEMBER VALUE', 'move PATCH X,Y' or 'raise PATCH'; 'set' and 'move' may end in 'over 50ms' "
      "(default: 10 ms). LAYER is the layer's index or type; of a piece in space write PIECE.MEMBER; VALUE a "
      "number within the member's slider, in "
      "the unit of its name ('info' lists the sliders); X,Y is the place of the patch's centre, as in "
      "10mm,20mm; "
      "'raise' makes the patch the topmost one. A command is sent up to 20 ms after its time; the session "
      "has its tick");
  declare_hold_stable(app, options->hold_stable);
  declare_texture(app, options->play);
  declare_loop(app, *options);
  declare_choices(app, options->play.program.choices);
  declare_tick_budget(app, options->budget);
  app.footer(
      app.get_footer() +
      "\nCtrl-C ends the playback before its time: the drive falls to zero within 10 ms without a step, "
      "the session is complete, and the report is that of any other end (exit code 0). A second "
      "Ctrl-C ends the program at once; then the device ramps to zero by itself (a card on comedi: needs its "
      "watchdog for this), and 'session' and 'replay' read the session up to its last ticks.");
  return [options, &app]() -> Result<Report> {
    TACTO_TRY(check_scene_options(app, *options));
    return run_play(*options);
  };
}

}  // namespace

const cli::Verb kPlayVerb{"play", "Play a texture or scene on a device, live, and keep the session",
                          "tactograph play oak -d usb: --time 60s -o first\n"
                          "  tactograph play oak -d sim: --finger-path path.csv -o first\n"
                          "  tactograph play plane.scene.json -d sim:planar,hand=minsky-radial --finger-path "
                          "hand.csv --script sliders.csv -o held\n"
                          "  tactograph play oak -d usb: -o first --max-error 0.2% --explain\n"
                          "  tactograph play oak -d usb: -o first --contact 0.3N --energy-limit 2V "
                          "--reconstruction butterworth3",
                          declare_play};

}  // namespace tacto::playback
