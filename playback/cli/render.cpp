// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "data-schema/cli/progress.hpp"
#include "data-schema/statistics.hpp"
#include "playback/cli/budget_report.hpp"
#include "playback/cli/gain_report.hpp"
#include "playback/cli/verbs.hpp"
#include "playback/drive_files.hpp"
#include "playback/render.hpp"

namespace tacto::playback {

using cli::Report;
using schema::Dimension;
using schema::Result;

namespace {

struct RenderVerbOptions {
  std::string texture, path, transducer, drive, displacement, wanted;
  bool force = false;
  RenderOptions render;
  AskedBudget budget;
  CLI::Option* engine = nullptr;
  std::optional<double> gain_m_per_n;
  std::optional<schema::PlaybackGain> kept_gain;
};

void add_files(CLI::App& app, RenderVerbOptions& o) {
  app.add_option("texture", o.texture, "Texture: its stem, NAME.texture.json or NAME.texture.wav")
      ->required();
  app.add_option("--path", o.path,
                 "Finger path: CSV with the columns time_s,position_m; between its points by monotone cubics")
      ->required();
  app.add_option("--transducer", o.transducer, "Transducer: a preset or NAME.transducer.json")->required();
  app.add_flag("--force", o.force, "Take a transducer file that says of itself that its model does not fit");
  app.add_option("-o,--output", o.drive, "The drive: float WAV in volts at the amplifier's input")
      ->required();
  app.add_option("--displacement", o.displacement,
                 "Also write what the modelled tray does with that drive: float WAV in metres");
  app.add_option("--wanted", o.wanted, "Also write the displacement that was wanted: float WAV in metres");
}

void add_quantities(CLI::App& app, RenderVerbOptions& verb) {
  RenderOptions& o = verb.render;
  cli::add_quantity(app, "--rate", o.rate_hz, Dimension::frequency, "Sample rate of the drive");
  cli::add_quantity(app, "--gain", verb.gain_m_per_n, Dimension::compliance,
                    "Displacement for force; unless told the one that the texture keeps, or 1mm/N");
  cli::add_quantity(
      app, "--at", o.at_m, Dimension::length,
      "Where the texture's position 0 lies on the path's axis; for a path in bench positions give the "
      "source_origin_m that `info TEXTURE` tells");
  cli::add_quantity(app, "--low", o.band.low_hz, Dimension::frequency,
                    "Lowest frequency of the displacement");
  cli::add_quantity(app, "--high", o.band.high_hz, Dimension::frequency,
                    "Highest frequency of the displacement");
  cli::add_quantity(app, "--onset", o.onset_s, Dimension::time,
                    "Fade at either end of the path, for a finger that starts inside the texture");
}

// By the words of play. A path tells no normal force: there is no contact.
void add_kernel(CLI::App& app, RenderVerbOptions& verb) {
  RenderOptions& o = verb.render;
  verb.budget.reading =
      cli::add_choice<wire::Interpolation>(app, "--interpolation", o.interpolation,
                                           {{"nearest", wire::Interpolation::nearest},
                                            {"linear", wire::Interpolation::linear},
                                            {"hermite", wire::Interpolation::hermite},
                                            {"sinc", wire::Interpolation::sinc}},
                                           "How the kernel reads the texture between samples")
          ->needs(verb.engine);
  CLI::Option* limit =
      cli::add_quantity(app, "--energy-limit", o.energy_rms_v, Dimension::voltage,
                        "Turn the kernel's drive down where its RMS would pass this; 0V: never")
          ->needs(verb.engine);
  cli::add_quantity(app, "--energy-window", o.energy_window_s, Dimension::time,
                    "Over which that RMS is taken")
      ->needs(limit);
}

void add_model(CLI::App& app, RenderVerbOptions& verb) {
  RenderOptions& o = verb.render;
  CLI::Option* inverse =
      cli::add_choice<Inverse>(app, "--inverse", o.inverse,
                               {{"full", Inverse::full},
                                {"magnitude", Inverse::magnitude},
                                {"gain", Inverse::gain},
                                {"none", Inverse::none}},
                               "What of the transducer the drive undoes: amplitude and phase, amplitude, the "
                               "gain at rest, or nothing");
  CLI::Option* reconstruction = cli::add_choice<Reconstruction>(
      app, "--reconstruction", o.reconstruction,
      {{"none", Reconstruction::none}, {"butterworth3", Reconstruction::butterworth3}},
      "Analog filter behind the converter, undone as well");
  cli::add_quantity(app, "--cutoff", o.reconstruction_cutoff_hz, Dimension::frequency,
                    "Cut-off of butterworth3")
      ->needs(reconstruction);
  cli::add_choice<Hold>(app, "--hold", o.hold, {{"none", Hold::none}, {"zero-order", Hold::zero_order}},
                        "Whether the converter holds each sample until the next, undone as well");
  app.add_flag("!--keep-hysteresis", o.undo_hysteresis,
               "Do not undo the hysteresis that the transducer's file tells (the kernel does)");
  CLI::Option* engine = verb.engine = cli::add_choice<Engine>(
      app, "--engine", o.engine, {{"reference", Engine::reference}, {"kernel", Engine::kernel}},
      "Who computes the drive: the exact reference, or the tick kernel as it runs in real time");
  cli::add_quantity(app, "--encoder-step", o.encoder_step_m, Dimension::length,
                    "One count of the kernel's encoder")
      ->needs(engine);
  add_kernel(app, verb);
  cli::add_choice<OverLimit>(app, "--over-limit", o.over_limit,
                             {{"refuse", OverLimit::refuse}, {"clip", OverLimit::clip}},
                             "What to do with a drive that passes a limit of the transducer");
  declare_tick_budget(app, verb.budget);
  verb.budget.inverse = inverse;
}

std::vector<SignalFile> files_of(const RenderVerbOptions& o, const Rendering& rendering) {
  std::vector<SignalFile> files{{o.drive, &rendering.drive_v}};
  if (!o.displacement.empty()) files.push_back({o.displacement, &rendering.modelled_m});
  if (!o.wanted.empty()) files.push_back({o.wanted, &rendering.wanted_m});
  return files;
}

void add_limits(Report& report, const Rendering& r) {
  report.add("drive_peak_v", r.peaks.drive_v.value)
      .add("drive_limit_used_percent", 100 * r.peaks.drive_v.used())
      .add("displacement_peak_m", r.peaks.displacement_m.value)
      .add("displacement_limit_used_percent", 100 * r.peaks.displacement_m.used())
      .add("slew_peak_v_per_s", r.peaks.slew_v_per_s.value)
      .add("slew_limit_used_percent", 100 * r.peaks.slew_v_per_s.used());
  if (r.engine == Engine::kernel)
    report.add("energy_limited_samples", r.energy_limited_samples).add("limits_removed_db", r.removed_db);
  if (!r.clipping) return;
  report.add("clipped_samples", r.clipping->samples)
      .add("clipped_peak_reduction_db", r.clipping->peak_reduced_db)
      .add("clipped_removed_db", r.clipping->removed_db);
}

void add_way(Report& report, const Rendering& r) {
  report.add("samples_outside_texture", r.samples_outside)
      .add("texture_end_fade_m", r.fade_m)
      .add("onset_s", r.onset_s)
      .add("max_speed_mps", r.max_speed_mps)
      .add("highest_passed_at_max_speed_per_m", r.highest_passed_per_m)
      .add("texture_highest_per_m", r.texture_highest_per_m)
      .add("reading_rate_hz", r.reading_rate_hz);
}

Report report_of(const RenderVerbOptions& o, const schema::Transducer& transducer, const Rendering& r) {
  Report report;
  report.add("drive", o.drive).add("transducer", transducer.name).add("duration_s", r.drive_v.duration_s());
  report.add("rate_hz", r.drive_v.sample_rate_hz).add("gain_m_per_n", o.render.gain_m_per_n);
  add_kept_gain(report, o.kept_gain);
  report.add("drive_rms_v", schema::statistics_of(r.drive_v.values).rms())
      .add("wanted_rms_m", schema::statistics_of(r.wanted_m.values).rms());
  report.add("displacement_error_db", r.error_db).add("delay_s", r.delay_s);
  if (o.render.budget.asked()) report.add("engine", r.engine == Engine::kernel ? "kernel" : "reference");
  if (r.decision) add_decision(report, *r.decision, o.budget.options.explain);
  if (o.budget.options.explain && !r.reasons.empty()) report.add("why_this_engine", r.reasons);
  add_limits(report, r);
  add_way(report, r);
  return report;
}

void warn_of(const Rendering& r) {
  for (const std::string& warning : r.warnings) cli::warn(warning);
  if (!r.clipping) return;
  cli::warn(fmt::format(
      "the limits clipped {} samples: the peak is {:.1f} dB lower, what was removed is {:.1f} dB re "
      "the whole drive",
      r.clipping->samples, r.clipping->peak_reduced_db, r.clipping->removed_db));
}

// The signals' addresses serve as names only: nothing is rendered yet.
Result<void> check_outputs(const RenderVerbOptions& o) {
  return check_signal_files(files_of(o, Rendering{}));
}

Result<Rendering> rendered(RenderVerbOptions& o, const schema::Transducer& transducer) {
  const auto texture = schema::read_texture(o.texture);
  if (!texture) return schema::forward_error(texture);
  if (!o.gain_m_per_n) o.kept_gain = texture->playback_gain;
  if (o.kept_gain) o.render.gain_m_per_n = o.kept_gain->gain_m_per_n;
  o.render.gain_m_per_n = o.gain_m_per_n.value_or(o.render.gain_m_per_n);
  const auto path = read_finger_path(o.path);
  if (!path) return schema::forward_error(path);
  cli::Progress progress("rendering");
  return render(*texture, *path, transducer, o.render, [&](double fraction) { progress.update(fraction); });
}

Result<Report> run_render(RenderVerbOptions o) {
  const auto budget = o.budget.budget();
  if (!budget) return schema::forward_error(budget);
  o.render.budget = *budget;
  o.render.keep_engine = o.engine->count() > 0;
  if (const auto sound = check_outputs(o); !sound) return schema::forward_error(sound);
  const auto transducer = schema::read_transducer(o.transducer);
  if (!transducer) return schema::forward_error(transducer);
  if (const auto usable = schema::check_usable(*transducer, o.force); !usable)
    return schema::forward_error(usable);
  const auto rendering = rendered(o, *transducer);
  if (!rendering) return schema::forward_error(rendering);
  if (const auto written = write_signal_files(files_of(o, *rendering)); !written)
    return schema::forward_error(written);
  warn_of(*rendering);
  return report_of(o, *transducer, *rendering);
}

cli::Action declare_render(CLI::App& app) {
  auto options = std::make_shared<RenderVerbOptions>();
  add_files(app, *options);
  add_quantities(app, *options);
  add_model(app, *options);
  return [options] { return run_render(*options); };
}

}  // namespace

const cli::Verb kRenderVerb{
    "render", "Play a texture along a finger path, offline: the drive for the transducer",
    "tactograph render oak --path path.csv --transducer wiertlewski2011 -o drive.wav --displacement tray.wav",
    declare_render};

}  // namespace tacto::playback
