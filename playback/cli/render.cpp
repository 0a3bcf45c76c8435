// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "data-schema/base/playback_defaults.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/recording/statistics.hpp"
#include "data-schema/report/progress.hpp"
#include "playback/choose/choices.hpp"
#include "playback/cli/play_options.hpp"
#include "playback/cli/play_reports.hpp"
#include "playback/cli/scene_forces.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/model/drive_files.hpp"
#include "playback/player/placed_textures.hpp"
#include "playback/player/silent_play.hpp"
#include "playback/render/render.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Dimension;
using schema::Result;

namespace {

/// Named options have priority over those of a scene.
struct NamedChoices {
  CLI::Option *inverse = nullptr, *interpolation = nullptr, *reconstruction = nullptr, *cutoff = nullptr,
              *hold = nullptr, *encoder_step = nullptr, *energy = nullptr, *energy_window = nullptr;
};

struct RenderVerbOptions {
  ProgramRequest what;
  FingerPathOption path;
  std::string transducer, device, hand, drive, displacement, target;
  schema::Existing existing = schema::Existing::keep;
  bool hold_stable = false;
  RenderOptions render;
  AskedBudget budget;
  CLI::Option *engine = nullptr, *rate = nullptr;
  NamedChoices named;
  std::optional<schema::PlaybackGain> kept_gain;
  std::optional<std::string> off_note;
  double signed_gain = 0, default_gain = 0;  ///< as reported; the weights of the textures have the signs
};

void add_files(CLI::App& app, RenderVerbOptions& o) {
  app.add_option("what", o.what.file, "Texture or scene: its stem, NAME.texture.json, NAME.scene.json ...")
      ->required();
  declare_finger_path(app, o.path,
                      "Path of the finger, interpolated by monotone cubics (with --device: of the hand, with "
                      "a column for each axis, as in time_s,x_mm,y_mm): ")
      ->required();
  app.add_option("--transducer", o.transducer,
                 fmt::format("Of a texture or a scene of a tray: a preset ({}) or NAME.transducer.json",
                             fmt::join(schema::preset_names(), ", ")));
  declare_force_device(app, o.device);
  declare_hand(app, o.hand);
  declare_hold_stable(app, o.hold_stable);
  cli::declare_unfit_transducer(app, o.what.unfit_transducer);
  app.add_flag("--implausible", o.what.implausible,
               "Accept a transducer file with impossible numbers, for example a mass of 1e-12 kg");
  app.add_option(
         "-o,--output", o.drive,
         "The drive: float WAV in volts at the amplifier's input; with --device the forces on the hand: CSV")
      ->required();
  cli::declare_force(app, o.existing);
  app.add_option("--displacement", o.displacement,
                 "Also write the displacement of the modelled tray under that drive: float WAV in metres");
  app.add_option("--target", o.target, "Also write the target displacement: float WAV in metres");
}

void add_quantities(CLI::App& app, RenderVerbOptions& verb) {
  RenderOptions& o = verb.render;
  verb.rate = cli::add_quantity(app, "--rate", o.rate_hz, Dimension::frequency,
                                "Sample rate of the drive; with --device: tick rate, default its largest");
  cli::add_gain(app, verb.what.gain, "Gain of a texture: ", kDefaultGain);
  cli::add_quantity(app, "--at", verb.what.at_m, Dimension::length,
                    "Of a texture: path position of its position 0; for a path in bench positions give the "
                    "source_origin_m that `info TEXTURE` prints");
  cli::add_quantity(app, "--low", o.band.low_hz, Dimension::frequency,
                    "Lowest frequency of the displacement");
  cli::add_quantity(app, "--high", o.band.high_hz, Dimension::frequency,
                    "Highest frequency of the displacement");
  cli::add_quantity(
      app, "--onset", o.onset_s, Dimension::time,
      "Fade of the force at both ends of the path, for a finger that starts inside the texture; default: "
      "5ms. With --engine kernel the drive's onset, as in play; default: " +
          schema::for_people(schema::kOnsetS, Dimension::time));
}

// The same names as in play. A path has no normal force, so there is no contact.
void add_kernel(CLI::App& app, RenderVerbOptions& verb) {
  RenderOptions& o = verb.render;
  verb.budget.reading = verb.named.interpolation = cli::add_choice<wire::Interpolation>(
      app, "--interpolation", o.interpolation,
      {{"nearest", wire::Interpolation::nearest},
       {"linear", wire::Interpolation::linear},
       {"hermite", wire::Interpolation::hermite},
       {"sinc", wire::Interpolation::sinc}},
      "With --engine kernel: interpolation between the texture's samples");
  verb.named.energy = cli::add_quantity(
      app, "--energy-limit", o.energy_rms_v, Dimension::voltage,
      "With --engine kernel: largest RMS of the drive; beyond it the drive is reduced; 0V: no limit");
  verb.named.energy_window =
      cli::add_quantity(app, "--energy-window", o.energy_window_s, Dimension::time, "Time window of that RMS")
          ->needs(verb.named.energy);
}

void add_model(CLI::App& app, RenderVerbOptions& verb) {
  RenderOptions& o = verb.render;
  verb.budget.inverse = verb.named.inverse =
      cli::add_choice<Inverse>(app, "--inverse", o.inverse,
                               {{"full", Inverse::full},
                                {"magnitude", Inverse::magnitude},
                                {"gain", Inverse::gain},
                                {"none", Inverse::none}},
                               "What the drive inverts of the transducer: amplitude and phase, amplitude, "
                               "the gain at rest, or nothing");
  verb.named.reconstruction = cli::add_choice<Reconstruction>(
      app, "--reconstruction", o.reconstruction,
      {{"none", Reconstruction::none}, {"butterworth3", Reconstruction::butterworth3}},
      "Analog filter behind the converter, inverted as well; butterworth3 replaces the filter of the "
      "transducer's file");
  verb.named.cutoff = cli::add_quantity(app, "--cutoff", o.reconstruction_cutoff_hz, Dimension::frequency,
                                        "Cut-off of butterworth3")
                          ->needs(verb.named.reconstruction);
  verb.named.hold =
      cli::add_choice<Hold>(app, "--hold", o.hold, {{"none", Hold::none}, {"zero-order", Hold::zero_order}},
                            "Whether the converter holds each sample until the next, inverted as well");
  app.add_flag_callback(
      "--keep-hysteresis", [&o] { o.undo_hysteresis = false; },
      "Do not invert the hysteresis of the transducer's file (only --engine kernel inverts it)");
  verb.engine = cli::add_choice<Engine>(
      app, "--engine", o.engine, {{"reference", Engine::reference}, {"kernel", Engine::kernel}},
      "Engine that computes the drive: the exact reference, or the tick kernel as it runs in real time");
  verb.named.encoder_step = cli::add_quantity(app, "--encoder-step", o.encoder_step_m, Dimension::length,
                                              "With --engine kernel: length of one encoder count");
  add_kernel(app, verb);
  cli::add_choice<OverLimit>(app, "--over-limit", o.over_limit,
                             {{"refuse", OverLimit::refuse}, {"clip", OverLimit::clip}},
                             "What to do with a drive that exceeds a limit of the transducer");
  declare_tick_budget(app, verb.budget);
}

std::vector<SignalFile> files_of(const RenderVerbOptions& o, const Rendering& rendering) {
  std::vector<SignalFile> files{{o.drive, &rendering.drive_v}};
  if (!o.displacement.empty()) files.push_back({o.displacement, &rendering.modelled_m});
  if (!o.target.empty()) files.push_back({o.target, &rendering.target_m});
  return files;
}

void add_limits(Report& report, const Rendering& r) {
  report.add("drive_peak_v", r.peaks.drive_v.value)
      .add("drive_limit_used_percent", 100 * r.peaks.drive_v.used())
      .add("displacement_peak_m", r.peaks.displacement_m.value)
      .add("displacement_limit_used_percent", 100 * r.peaks.displacement_m.used())
      .add("slew_peak_v_per_s", r.peaks.slew_v_per_s.value)
      .add("slew_limit_used_percent", 100 * r.peaks.slew_v_per_s.used());
  if (r.engine == Engine::kernel) report.add("energy_limited_samples", r.energy_limited_samples);
  if (r.removed_db) report.add("limits_removed_db", *r.removed_db);
  if (r.engine == Engine::kernel && !r.removed_db) report.add("limits_removed", "none");
  if (!r.clipping) return;
  report.add("clipped_samples", r.clipping->samples)
      .add("clipped_peak_reduction_db", r.clipping->peak_reduced_db)
      .add("clipped_removed_db", r.clipping->removed_db);
}

// The first error is the one without the path's ends, where a step or the onset is most of the error.
void add_errors(Report& report, const Rendering& r) {
  if (r.interior_error_db)
    report.add("interior_displacement_error_db", *r.interior_error_db)
        .add("left_out_at_each_end_s", left_out_at_ends_s(r));
  report.add("displacement_error_db", r.error_db);
}

void add_way(Report& report, const Rendering& r) {
  add_loop(report, r.loop_period_m, r.loop_seam_m);
  report.add("samples_outside_texture", r.samples_outside)
      .add("texture_end_fade_m", r.fade_m)
      .add("onset_s", r.onset_s)
      .add("max_speed_mps", r.max_speed_mps)
      .add("highest_passed_at_max_speed_per_m", r.highest_passed_per_m)
      .add("highest_of_texture_grid_per_m", r.texture_highest_per_m)
      .add("reading_rate_hz", r.reading_rate_hz);
}

Report report_of(const RenderVerbOptions& o, const schema::Transducer& transducer, const Rendering& r) {
  Report report;
  report.add("drive", o.drive).add("transducer", transducer.name).add("duration_s", r.drive_v.duration_s());
  report.add("rate_hz", r.drive_v.sample_rate_hz);
  add_gain(report, o.signed_gain, o.default_gain);
  add_kept_gain(report, o.kept_gain);
  report.add("drive_rms_v", schema::statistics_of(r.drive_v.values).rms())
      .add("target_rms_m", schema::statistics_of(r.target_m.values).rms());
  add_errors(report, r);
  report.add("delay_s", r.delay_s);
  if (o.render.budget.asked()) report.add("engine", r.engine == Engine::kernel ? "kernel" : "reference");
  if (r.decision) add_decision(report, *r.decision, o.budget.options.explain);
  if (o.budget.options.explain && !r.reasons.empty()) report.add("why_this_engine", r.reasons);
  add_limits(report, r);
  add_way(report, r);
  return report;
}

void warn_of(const RenderVerbOptions& o, const Rendering& r) {
  for (const std::string& warning : r.warnings) cli::warn(warning);
  if (o.off_note) cli::warn(*o.off_note);
  if (!r.clipping) return;
  cli::warn(
      fmt::format("the limits clipped {} samples: the peak is {:.1f} dB lower, the removed part is {:.1f} dB "
                  "re the whole drive",
                  r.clipping->samples, r.clipping->peak_reduced_db, r.clipping->removed_db));
}

void warn_of_version(const std::string& name, const schema::Transducer& transducer) {
  if (const std::string note = schema::unknown_note(name, transducer); !note.empty()) cli::warn(note);
}

// Options that the reference does not have.
Result<void> check_kernels(const RenderVerbOptions& o) {
  if (o.engine->count() > 0 && o.render.engine == Engine::kernel) return {};
  for (const CLI::Option* named : {o.named.encoder_step, o.named.interpolation, o.named.energy})
    if (named->count() > 0)
      return schema::fail(schema::ErrorKind::usage, named->get_name() + " requires --engine kernel", {},
                          "the reference reads the texture at exact positions, and has no energy limit");
  return {};
}

// Nothing is rendered yet; the empty signals only stand for their files.
Result<void> check_outputs(const RenderVerbOptions& o) {
  return check_signal_files(files_of(o, Rendering{}), o.existing);
}

// Uses the scene's choices where no option was named.
Result<void> take_choices(RenderVerbOptions& o, const schema::PlaybackChoices& scene) {
  const auto played = with_choices({}, scene);
  TACTO_TRY(played);
  const auto take = [](bool said, const CLI::Option* named, auto& option, const auto& value) {
    if (said && named->count() == 0) option = value;
  };
  RenderOptions& r = o.render;
  take(scene.inverse.has_value(), o.named.inverse, r.inverse, played->inverse);
  take(scene.interpolation.has_value(), o.named.interpolation, r.interpolation, played->interpolation);
  take(scene.reconstruction.has_value(), o.named.reconstruction, r.reconstruction, played->reconstruction);
  take(scene.cutoff_hz.has_value(), o.named.cutoff, r.reconstruction_cutoff_hz,
       played->reconstruction_cutoff_hz);
  take(scene.hold.has_value(), o.named.hold, r.hold, played->hold);
  take(scene.energy_rms_v.has_value(), o.named.energy, r.energy_rms_v, played->energy_rms_v);
  take(scene.energy_window_s.has_value(), o.named.energy_window, r.energy_window_s, played->energy_window_s);
  if (played->contact_on_n > 0)
    cli::warn("the path has no normal force: the scene's contact gate is left out");
  return {};
}

Result<Rendering> rendered(RenderVerbOptions& o, const schema::Transducer& transducer) {
  const auto laid = place_textures(o.what);
  TACTO_TRY(laid);
  TACTO_TRY(take_choices(o, laid->choices()));
  for (const std::string& note : laid->notes()) cli::warn(note);
  o.kept_gain = laid->kept_gain();
  o.render.gain_m_per_n = laid->gain();
  o.signed_gain = laid->signed_gain();
  o.default_gain = laid->default_gain();
  o.render.default_gain_m_per_n = std::abs(o.default_gain);
  o.render.ends = laid->ends();
  const auto path = o.path.read();
  TACTO_TRY(path);
  cli::Progress progress("rendering");
  auto rendering = render(laid->placed(), *path, transducer, o.render,
                          [&](double fraction) { progress.update(fraction); });
  if (!rendering) return rendering;
  const auto [least, most] = std::ranges::minmax(path->position_m);
  const auto samples = static_cast<double>(rendering->drive_v.values.size());
  o.off_note = note_off_textures(static_cast<double>(rendering->samples_outside) / samples, least, most,
                                 {laid->start_m(), laid->end_m()});
  return rendering;
}

// One of --transducer and --device.
Result<Report> run_render(RenderVerbOptions o) {
  if (o.transducer.empty())
    return schema::fail(
        schema::ErrorKind::usage, "--transducer or --device is required", {},
        fmt::format(
            "a tray has a transducer: a preset ({}) or NAME.transducer.json; a scene with force patches "
            "is played by a force device: a preset ({}) or NAME.device.json",
            fmt::join(schema::preset_names(), ", "), fmt::join(schema::device_preset_names(), ", ")));
  const auto budget = o.budget.budget();
  TACTO_TRY(budget);
  o.render.budget = *budget;
  o.render.keep_engine = o.engine->count() > 0;
  TACTO_TRY(check_kernels(o));
  TACTO_TRY(check_outputs(o));
  const auto transducer = schema::read_transducer(
      o.transducer, o.what.implausible ? schema::Numbers::computable : schema::Numbers::plausible);
  TACTO_TRY(transducer);
  TACTO_TRY(schema::check_usable(*transducer, o.what.unfit_transducer));
  warn_of_version(o.transducer, *transducer);
  const auto rendering = rendered(o, *transducer);
  TACTO_TRY(rendering);
  TACTO_TRY(write_signal_files(files_of(o, *rendering), o.existing));
  warn_of(o, *rendering);
  return report_of(o, *transducer, *rendering);
}

cli::Action declare_render(CLI::App& app) {
  auto options = std::make_shared<RenderVerbOptions>();
  add_files(app, *options);
  add_quantities(app, *options);
  declare_ends(app, options->what.ends);
  add_model(app, *options);
  return [options, &app]() -> Result<Report> {
    const RenderVerbOptions& o = *options;
    if (o.device.empty() && (!o.hand.empty() || o.hold_stable))
      return schema::fail(schema::ErrorKind::usage,
                          o.hold_stable ? "--hold-stable requires --device" : "--hand requires --device");
    if (o.device.empty()) return run_render(o);
    TACTO_TRY(check_force_options(
        app, {"finger-path", "device", "hand", "hold-stable", "output", "rate", "force"}));
    const auto rate_hz = o.rate->count() > 0 ? std::optional(o.render.rate_hz) : std::nullopt;
    return render_forces(
        {o.what.file, o.device, o.path.file, o.drive, o.hand, rate_hz, o.existing, o.hold_stable});
  };
}

}  // namespace

const cli::Verb kRenderVerb{
    "render",
    "Play a texture or scene along a path, offline: the drive of a transducer or the forces of a device",
    "tactograph render oak --finger-path path.csv --transducer wiertlewski2011 -o drive.wav --displacement "
    "tray.wav\n"
    "  tactograph render bench.scene.json --finger-path path.csv --transducer wiertlewski2011 --engine "
    "kernel -o drive.wav\n"
    "  tactograph render plane.scene.json --finger-path hand.csv --device sandpaper-1990 -o forces.csv",
    declare_render};

}  // namespace tacto::playback
