// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "data-schema/base/decibels.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/base/playback_defaults.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/recording/statistics.hpp"
#include "firmware-host/core/kernel/profile.hpp"
#include "playback/model/chain.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/model/identified_band.hpp"
#include "playback/model/limits.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/model/texture_lookup.hpp"
#include "playback/prepare/kernel_drive.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/prepare/texture_check.hpp"
#include "playback/prepare/texture_layout.hpp"
#include "playback/render/loop_seam.hpp"
#include "playback/render/reference/exact_drive.hpp"
#include "playback/render/reference/exact_target.hpp"
#include "playback/render/reference/padded_spectrum.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kLeftOutAtEnds_s = 1;

double rms_between_ends(const std::vector<double>& values, std::size_t left_out) {
  return schema::statistics_of(std::span(values).subspan(left_out, values.size() - 2 * left_out)).rms();
}

std::vector<double> without(std::vector<double> values, const std::vector<double>& less) {
  std::ranges::transform(values, less, values.begin(), std::minus<>());
  return values;
}

std::vector<double> in_band(const std::vector<double>& values, const PaddedSpectrum& target,
                            const spatial::Band& band) {
  auto spectrum = spectrum_of(values, target.rate_hz, target.period);
  keep_band(spectrum, band);
  return signal_of(spectrum);
}

// The target is filtered to the band with skirts, and so is the reference's displacement; the kernel's is
// not.
std::vector<double> error_of(const Rendering& rendering, const PaddedSpectrum& target,
                             const spatial::Band& band) {
  const auto &modelled_m = rendering.modelled_m.values, &target_m = rendering.target_m.values;
  if (rendering.engine == Engine::kernel) return without(in_band(modelled_m, target, band), target_m);
  return in_band(without(modelled_m, target_m), target, band);
}

// The input of one rendering, for both engines.

struct RenderJob {
  std::span<const PlacedTexture> textures;
  const FingerPath& path;
  const PaddedSpectrum& target;
  Chain chain;
  RenderOptions options;
};

// The part of render() that uses the kernel.

PrepareOptions kernel_options(const RenderOptions& o, double onset_s) {
  PrepareOptions options;
  options.rate_hz = o.rate_hz;
  options.metres_per_count = o.encoder_step_m;
  options.gain_m_per_n = o.gain_m_per_n;
  options.band = o.band;
  options.ends = o.ends;
  options.inverse = o.inverse;
  options.reconstruction = o.reconstruction;
  options.reconstruction_cutoff_hz = o.reconstruction_cutoff_hz;
  options.hold = o.hold;
  options.onset_s = onset_s;
  options.interpolation = o.interpolation;
  options.energy_rms_v = o.energy_rms_v;
  options.energy_window_s = o.energy_window_s;
  options.undo_hysteresis = o.undo_hysteresis;
  return options;
}

// Writes the choice of the budget into the options.
Result<void> decide_kernel(Rendering& rendering, const RenderJob& job, PrepareOptions& options) {
  const TickBudget& budget = job.options.budget;
  if (!budget.asked()) return {};
  const auto table = schema::find_trade_table();
  TACTO_TRY(table);
  auto decision = decide(job.textures, job.chain.transducer, options, budget, *table);
  TACTO_TRY(decision);
  options = decision->chosen.in(options);
  rendering.decision = std::move(*decision);
  return {};
}

/// One texture along one path at any gain.
struct KernelRun {
  const Prepared& prepared;
  const PrepareOptions& options;
  const RenderJob& job;

  // Peaks of the unlimited drive.
  Peaks asked_at(double gain_m_per_n) const {
    const auto drive_v = unlimited_drive(prepared, gain_m_per_n, job.path, options, job.target.samples);
    Peaks peaks = modelled_from(drive_v, job.target, job.chain).peaks;
    peaks.slew_v_per_s =
        peaks_of(drive_v, {}, options.rate_hz, job.chain.transducer, AfterDrive::more).slew_v_per_s;
    return peaks;
  }
};

// `passed`: the peak that the error names; none: the tightest one.
tl::unexpected<schema::Error> refuse(const KernelRun& run, const std::optional<Peak>& passed, bool may_clip) {
  const RenderOptions& o = run.job.options;
  const Peaks asked = run.asked_at(o.gain_m_per_n);
  const double fits = fitting_gain(o.gain_m_per_n, asked, [&](double gain) { return run.asked_at(gain); });
  return limit_passed(passed.value_or(asked.tightest()), fits, o.default_gain_m_per_n, may_clip);
}

// Reports what was clipped; a displacement beyond its limit is refused, because nothing clips it.
Result<ExactDrive> within_limits(Rendering& rendering, const KernelRun& run, const KernelDrive& drive) {
  const auto clipped =
      static_cast<std::size_t>(std::max(drive.tally.amplitude_limited(), drive.tally.slew_limited()));
  ExactDrive moved = modelled_from(drive.drive_v, run.job.target, run.job.chain);
  const bool too_far = moved.peaks.displacement_m.used() > 1;
  if (clipped > 0 && run.job.options.over_limit == OverLimit::refuse) return refuse(run, {}, !too_far);
  if (too_far) return refuse(run, moved.peaks.displacement_m, false);
  if (clipped > 0) rendering.clipping = {clipped, 0, drive.tally.removed_db()};
  rendering.energy_limited_samples = drive.tally.energy_limited();
  if (drive.tally.removed_any()) rendering.removed_db = drive.tally.removed_db();
  return moved;
}

double farthest_of(const FingerPath& path) {
  double farthest_m = 0;
  for (const double position_m : path.position_m) farthest_m = std::max(farthest_m, std::abs(position_m));
  return farthest_m;
}

// With several samples per count the reading range is smaller than the counting range.
Result<void> check_read(const Prepared& prepared, const FingerPath& path, const PrepareOptions& options) {
  const double farthest_m = farthest_of(path);
  const double reach_m = options.metres_per_count * core::reach_counts(prepared.scale);
  if (farthest_m <= reach_m) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format(
          "the path reaches {:.4g} m, the kernel reads the texture up to {:.4g} m from the encoder's zero",
          farthest_m, reach_m),
      "--finger-path", "place path and texture (--at) nearer to it, or render with --engine reference");
}

// Beyond that count the kernel's output is zero (core/kernel/profile.cpp).
// Errors: unsuitable, for a path beyond the range of the kernel's encoder.
Result<void> check_counts(const FingerPath& path, const RenderOptions& o) {
  constexpr double kFarthestCount = 1 << 29;
  const double farthest_m = farthest_of(path);
  if (farthest_m / o.encoder_step_m < kFarthestCount) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("the path reaches {:.4g} m, which is more than 2^29 encoder counts", farthest_m),
              "--encoder-step",
              fmt::format("use {:.3g} nm or more", std::ceil(1e9 * farthest_m / kFarthestCount * 1.01)));
}

// The kernel's drive along the job's path, and the displacement; writes to `rendering` what the limits
// removed and what the budget chose. Errors: as prepare(), decide(); unsuitable, for a drive that its limits
// clip (unless over_limit allows it) or a displacement beyond its limit: which peak, when, and the largest
// gain that fits. The kernel does not limit displacement, so that is never clipped. The end of the drive is
// not counted as a step to rest, because a playback continues.
Result<ExactDrive> kernels_drive(Rendering& rendering, const RenderJob& job) {
  PrepareOptions options = kernel_options(job.options, rendering.onset_s);
  TACTO_TRY(decide_kernel(rendering, job, options));
  const auto prepared = prepare(job.textures, job.chain.transducer, options);
  TACTO_TRY(prepared);
  TACTO_TRY(check_read(*prepared, job.path, options));
  const KernelDrive drive = kernel_drive(*prepared, job.path, options, job.target.samples);
  auto moved = within_limits(rendering, {*prepared, options, job}, drive);
  if (!moved) return moved;
  rendering.warnings.insert(rendering.warnings.end(), prepared->notes.begin(), prepared->notes.end());
  rendering.delay_s = prepared->delay_left_s;
  return moved;
}

/// Textures at their positions, continued beyond their ends, along one path. The path must outlive this.
class TexturePath {
 public:
  /// Errors: as as_played().
  static Result<TexturePath> make(std::span<const PlacedTexture> textures, const FingerPath& path,
                                  Ends ends) {
    TexturePath texture_path(path);
    const auto [low_m, high_m] = std::ranges::minmax(path.position_m);
    texture_path.start_m_ = textures.front().at_m, texture_path.end_m_ = texture_path.start_m_;
    for (const PlacedTexture& placed : textures) {
      auto played = as_played(*placed.texture, placed.at_m, prepared_ends(*placed.texture, ends), low_m,
                              high_m, "path");
      TACTO_TRY(played);
      const PlayedSignal& signal = texture_path.signals_.emplace_back(std::move(*played));
      texture_path.layers_.push_back({TextureLookup(signal.signal, signal.at_m), placed.weight});
      texture_path.start_m_ = std::min(texture_path.start_m_, placed.at_m);
      texture_path.end_m_ = std::max(texture_path.end_m_, placed.at_m + placed.texture->signal.length_m());
    }
    return texture_path;
  }

  /// Number of grid samples at which the finger is outside all textures.
  std::size_t count_outside(const ReadingGrid& grid) const {
    const auto positions = positions_along(*path_, grid.rate_hz, grid.samples);
    return static_cast<std::size_t>(std::ranges::count_if(positions, [&](double x) {
      return std::ranges::none_of(layers_, [&](const Layer& layer) { return layer.lookup.contains(x); });
    }));
  }

  /// The error for a path outside all textures: unsuitable, with their positions.
  tl::unexpected<schema::Error> outside_textures() const {
    const auto [low, high] = std::ranges::minmax(path_->position_m);
    const bool several = layers_.size() > 1;
    const auto shown = [](double length_m) {
      return schema::for_people(length_m, schema::Dimension::length);
    };
    return schema::fail(
        schema::ErrorKind::unsuitable,
        fmt::format("the finger moves from {} to {}, outside the texture{}, which {} at {} and {} {} long",
                    shown(low), shown(high), several ? "s" : "", several ? "begin" : "begins",
                    shown(start_m_), several ? "are" : "is", shown(end_m_ - start_m_)),
        "path", several ? "move them in the scene" : "--at moves the texture");
  }

  /// The widest fade at their ends.
  double fade_m() const {
    double widest_m = 0;
    for (const Layer& layer : layers_) widest_m = std::max(widest_m, layer.lookup.fade_m());
    return widest_m;
  }

  /// As exact_target, for the sum of the textures, each times its weight and gain_m_per_n.
  PaddedSpectrum target(const ReadingGrid& grid, const spatial::Band& band, double gain_m_per_n,
                        double onset_s) const {
    std::vector<double> readings = reading_places(*path_, grid);
    for (double& value : readings) {
      double force_n = 0;
      for (const Layer& layer : layers_) force_n += layer.weight * layer.lookup(value);
      value = gain_m_per_n * force_n;
    }
    return target_of_readings(std::move(readings), grid, band, onset_s);
  }

 private:
  struct Layer {
    TextureLookup lookup;
    double weight;
  };
  explicit TexturePath(const FingerPath& path) : path_(&path) {}

  const FingerPath* path_;
  std::deque<PlayedSignal> signals_;  // the lookups refer to these, so they must not move
  std::vector<Layer> layers_;
  double start_m_ = 0, end_m_ = 0;
};

// Beyond this the padded transforms alone need over a gigabyte.
constexpr double kMostSamples = 1 << 24;
// A thousand times the compliance of a fingertip; a larger gain is a mistake in the unit.
constexpr double kLargestGain = 1;

double level_db(double ratio) {
  return schema::amplitude_db(ratio);
}

Result<void> check_options(const RenderOptions& o) {
  const auto wrong = [](std::string what, std::string remedy) {
    return fail(ErrorKind::usage, std::move(what), {}, std::move(remedy));
  };
  if (!(o.band.low_hz > 0 && o.band.low_hz < o.band.high_hz && std::isfinite(o.band.high_hz)))
    return wrong("the band is empty or reaches 0 Hz", "0 < --low < --high");
  if (!(o.rate_hz > 2 * o.band.high_hz && std::isfinite(o.rate_hz)))
    return wrong(fmt::format("a rate of {:g} Hz can't hold a band up to {:g} Hz", o.rate_hz, o.band.high_hz),
                 fmt::format("use a --rate above {:g}Hz", 2 * o.band.high_hz));
  if (!(o.gain_m_per_n > 0 && o.gain_m_per_n <= kLargestGain))
    return wrong("the gain is 0, or larger than 1 m/N", "a fingertip needs about 1mm/N");
  if (!std::isfinite(o.at_m)) return wrong("the texture's place is not finite", "give --at a length");
  if (const double onset_s = o.onset_s.value_or(0); !(onset_s >= 0 && std::isfinite(onset_s)))
    return wrong("the onset is below 0", "0s turns it off");
  if (!(o.encoder_step_m > 0 && o.encoder_step_m < 1))
    return wrong("the encoder's step is not above 0", "1um is usual");
  if (!(o.reconstruction_cutoff_hz > 0))
    return wrong("the filter's cut-off is not above 0", "the paper's is 600Hz");
  return {};
}

Result<void> check_length(const FingerPath& path, const RenderOptions& options) {
  if (path.duration_s() < 1 / options.band.low_hz)
    return fail(ErrorKind::unsuitable,
                fmt::format("the path takes {:.4g} s, one period of {:g} Hz is longer", path.duration_s(),
                            options.band.low_hz),
                "path", "use a longer path, or a higher --low");
  if (path.duration_s() * options.rate_hz > kMostSamples)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("the path of {:.4g} s is too long: it has {:.4g} samples at {:g} Hz, and at most {:.4g} "
                    "can be rendered at once",
                    path.duration_s(), path.duration_s() * options.rate_hz, options.rate_hz, kMostSamples),
        "path",
        fmt::format("use a --rate up to {:.0f}Hz, or a shorter path", kMostSamples / path.duration_s()));
  return {};
}

Result<void> check_textures(std::span<const PlacedTexture> textures, Ends ends) {
  for (const PlacedTexture& placed : textures)
    if (auto sound = check_playable(*placed.texture); !sound) return sound;
  if (textures.size() > 1 && ends != Ends::stop)
    return fail(ErrorKind::unsuitable, "several textures can't be looped or mirrored", "ends",
                "use --ends stop");
  return {};
}

Result<void> check_inputs(std::span<const PlacedTexture> textures, const FingerPath& path,
                          const RenderOptions& options) {
  if (auto sound = check_options(options); !sound) return sound;
  if (auto sound = check_textures(textures, options.ends); !sound) return sound;
  if (auto sound = check_finger_path(path); !sound) return sound;
  return check_length(path, options);
}

Clipping clipping_of(const std::vector<double>& unlimited, const std::vector<double>& clipped) {
  std::vector<double> removed(unlimited.size());
  std::ranges::transform(unlimited, clipped, removed.begin(), std::minus<>());
  const auto peak = [](const std::vector<double>& v) {
    return std::abs(*std::ranges::max_element(v, {}, [](double x) { return std::abs(x); }));
  };
  const double smallest = 1e-6 * peak(unlimited);
  Clipping clipping;
  clipping.samples = static_cast<std::size_t>(
      std::ranges::count_if(removed, [&](double value) { return std::abs(value) > smallest; }));
  clipping.peak_reduced_db = level_db(peak(unlimited) / peak(clipped));
  clipping.removed_db =
      level_db(schema::statistics_of(removed).rms() / schema::statistics_of(unlimited).rms());
  return clipping;
}

Result<ExactDrive> limited_drive(Rendering& rendering, const PaddedSpectrum& target, const Chain& chain,
                                 const RenderOptions& options) {
  auto drive = exact_drive(target, options.band, chain, options.inverse);
  const auto within = check_limits(drive.peaks, options.gain_m_per_n, options.default_gain_m_per_n);
  if (within) return drive;
  if (options.over_limit == OverLimit::refuse) return schema::forward_error(within);
  auto held = clipped_drive(target, options.band, chain, options.inverse);
  if (held) rendering.clipping = clipping_of(drive.drive_v, held->drive_v);
  return held;
}

double error_db(const Rendering& rendering, const PaddedSpectrum& target, const spatial::Band& band) {
  std::vector<double> difference(rendering.target_m.values.size());
  std::ranges::transform(rendering.modelled_m.values, rendering.target_m.values, difference.begin(),
                         std::minus<>());
  const auto error = spectrum_of(difference, target.rate_hz, target.period);
  const auto whole = spectrum_of(rendering.target_m.values, target.rate_hz, target.period);
  return level_db(std::sqrt(energy_in(error, band) / energy_in(whole, band)));
}

void warn_of_folding(Rendering& rendering, const ReadingGrid& grid, const spatial::Band& band) {
  const double safe_hz = grid.reading_rate_hz() - band.high_hz;
  rendering.warnings.push_back(
      fmt::format("the path is too long to read the texture's finest content at full speed: content finer "
                  "than {:.4g} /mm may alias into the band at {:.4g} mm/s",
                  1e-3 * safe_hz / rendering.max_speed_mps, 1e3 * rendering.max_speed_mps));
}

void add_loop_of(Rendering& rendering, const schema::SpaceSignal& whole) {
  rendering.loop_seam_m = seam_of_loop(whole, PrepareOptions{}.seam_m);
  rendering.loop_period_m = static_cast<double>(whole.values.size()) * whole.pitch_m - rendering.loop_seam_m;
}

Rendering described(std::span<const PlacedTexture> textures, const FingerPath& path,
                    const RenderOptions& options, Engine engine) {
  const double usual_onset_s = engine == Engine::kernel ? schema::kOnsetS : kReferenceOnsetS;
  Rendering rendering;
  rendering.max_speed_mps = greatest_speed_mps(path);
  rendering.highest_passed_per_m = options.band.high_hz / rendering.max_speed_mps;
  for (const PlacedTexture& placed : textures)
    rendering.texture_highest_per_m =
        std::max(rendering.texture_highest_per_m, highest_spatial_frequency(placed.texture->signal));
  rendering.onset_s = std::min(options.onset_s.value_or(usual_onset_s), path.duration_s() / 4);
  if (options.ends == Ends::loop) add_loop_of(rendering, textures.front().texture->signal);
  return rendering;
}

Chain chain_of(const schema::Transducer& transducer, const RenderOptions& o) {
  return {transducer, o.reconstruction, o.reconstruction_cutoff_hz, o.hold, o.rate_hz};
}

// The kernel's error is measured against the reference, so offline the reference is computed in any case.
Engine engine_for(const RenderOptions& o, const schema::Transducer& transducer,
                  std::vector<std::string>& reasons) {
  if (!o.budget.asked() || o.keep_engine) return o.engine;
  if (o.budget.max_tick_ns) {
    reasons.emplace_back("the kernel: the reference has no ticks");
    return Engine::kernel;
  }
  if (transducer.hysteresis && o.undo_hysteresis) {
    reasons.emplace_back("the kernel: the reference does not invert the bender's hysteresis");
    return Engine::kernel;
  }
  reasons.emplace_back(
      "the reference: exact, and faster offline than the kernel, whose error would be measured against it");
  return Engine::reference;
}

Result<void> check_engine(Engine engine, const RenderOptions& o) {
  if (engine == Engine::kernel || !(o.budget.keep_reading || o.energy_rms_v > 0)) return {};
  return fail(ErrorKind::usage, "the reference reads the texture at exact positions, and has no energy limit",
              o.budget.keep_reading ? "--interpolation" : "--energy-limit", "add --engine kernel");
}

Result<void> drive_by(Engine engine, Rendering& rendering, const RenderJob& job) {
  auto drive = engine == Engine::kernel ? kernels_drive(rendering, job)
                                        : limited_drive(rendering, job.target, job.chain, job.options);
  TACTO_TRY(drive);
  const double start_s = job.path.time_s.front(), rate_hz = job.options.rate_hz;
  rendering.engine = engine;
  rendering.drive_v = {rate_hz, start_s, std::move(drive->drive_v)};
  rendering.modelled_m = {rate_hz, start_s, std::move(drive->modelled_m)};
  rendering.peaks = drive->peaks;
  rendering.error_db = error_db(rendering, job.target, job.options.band);
  const double interior_db = level_db(error_between_ends(rendering, job.target, job.options.band));
  if (std::isfinite(interior_db)) rendering.interior_error_db = interior_db;
  return {};
}

// The error, if it exceeds the budget.
std::optional<double> missed_error(const Rendering& rendering, const RenderJob& job) {
  if (job.options.budget.by_error()) return std::nullopt;
  const double error = error_between_ends(rendering, job.target, job.options.band);
  return error <= job.options.budget.error.most_error() ? std::nullopt : std::optional(error);
}

std::string words_of_miss(double error, const RenderOptions& o) {
  return fmt::format("error is {:.3g} % between the path's ends, requested: {:.3g} %", 100 * error,
                     100 * o.budget.error.most_error());
}

// Tests by a tenth of the encoder's step whether that step causes the error.
std::string ways_for_kernel(const Rendering& missed, RenderJob job) {
  job.options.encoder_step_m /= 10;
  Rendering finer = missed;
  if (!check_counts(job.path, job.options) || !drive_by(Engine::kernel, finer, job))
    return "allow a larger error, or omit --engine and --max-tick";
  if (!missed_error(finer, job))
    return fmt::format("use --encoder-step {:.4g}um, or allow a larger error",
                       1e6 * job.options.encoder_step_m);
  return fmt::format(
      "allow a larger error, or omit --engine and --max-tick: with a tenth of --encoder-step it is {:.3g} %",
      100 * error_between_ends(finer, job.target, job.options.band));
}

std::string ways_for_reference(const RenderJob& job) {
  if (job.chain.transducer.hysteresis)
    return "allow a larger error, or let the kernel invert the hysteresis: omit --engine and "
           "--keep-hysteresis";
  return "allow a larger error, or use --inverse full, or a smaller --gain that keeps the limits";
}

Result<void> refuse_miss(double error, const Rendering& rendering, const RenderJob& job) {
  if (std::isnan(error))
    return fail(ErrorKind::unsuitable, "the target is zero in the band: there is no error to measure",
                "error budget", "render without a budget");
  return fail(ErrorKind::unsuitable, "the rendering's " + words_of_miss(error, job.options), "error budget",
              rendering.engine == Engine::kernel ? ways_for_kernel(rendering, job) : ways_for_reference(job));
}

// The predicted error holds for constant speed and exact positions. A warning reports what the path and the
// encoder add to it.
void warn_beyond_promise(Rendering& rendering, const RenderJob& job) {
  if (!rendering.decision) return;
  const double error = error_between_ends(rendering, job.target, job.options.band);
  const double promised = rendering.decision->chosen.error;
  if (!(error > promised)) return;
  rendering.warnings.push_back(
      fmt::format("the rendering has an error of {:.3g} % between the path's ends: {:.3g} % are predicted "
                  "for the choice, the encoder's step of {:.4g} um and changes of speed add the rest",
                  100 * error, 100 * promised, 1e6 * job.options.encoder_step_m));
}

// The reference has no inverse of a hysteresis and no energy limit: then it cannot replace the kernel, nor if
// the kernel was named.
Result<void> keep_budget(Rendering& rendering, const RenderJob& job) {
  auto missed = missed_error(rendering, job);
  const bool stays =
      job.options.keep_engine || job.chain.transducer.hysteresis || job.options.energy_rms_v > 0;
  if (missed && !std::isnan(*missed) && rendering.engine == Engine::kernel && !stays) {
    rendering.warnings.push_back("the reference replaces the kernel: the kernel's " +
                                 words_of_miss(*missed, job.options));
    rendering.clipping.reset();
    rendering.removed_db.reset();
    rendering.decision.reset();
    rendering.delay_s = 0;
    if (auto driven = drive_by(Engine::reference, rendering, job); !driven) return driven;
    missed = missed_error(rendering, job);
  }
  if (missed) return refuse_miss(*missed, rendering, job);
  warn_beyond_promise(rendering, job);
  return {};
}

// The kernel's notes include the warning about the band.
void warn_of_model(Rendering& rendering, const schema::Transducer& transducer, const spatial::Band& band,
                   Engine engine) {
  if (engine == Engine::kernel) return;
  if (auto beyond = beyond_identified(transducer, band)) rendering.warnings.push_back(std::move(*beyond));
  if (transducer.hysteresis)
    rendering.warnings.push_back(
        "the reference inverts only the linear model, not the bender's hysteresis (--engine kernel inverts "
        "it)");
}

}  // namespace

double left_out_at_ends_s(const Rendering& rendering) {
  return std::min(std::max(kLeftOutAtEnds_s, rendering.onset_s), rendering.target_m.duration_s() / 4);
}

double error_between_ends(const Rendering& rendering, const PaddedSpectrum& target,
                          const spatial::Band& band) {
  const auto left_out = static_cast<std::size_t>(left_out_at_ends_s(rendering) * target.rate_hz);
  return rms_between_ends(error_of(rendering, target, band), left_out) /
         rms_between_ends(rendering.target_m.values, left_out);
}

Result<Rendering> render(std::span<const PlacedTexture> textures, const FingerPath& path,
                         const schema::Transducer& transducer, const RenderOptions& options,
                         const std::function<void(double)>& progress) {
  TACTO_TRY(check_inputs(textures, path, options));
  const auto report = [&](double fraction) {
    if (progress) progress(fraction);
  };
  std::vector<std::string> reasons;
  const Engine engine = engine_for(options, transducer, reasons);
  TACTO_TRY(check_engine(engine, options));
  if (engine == Engine::kernel) TACTO_TRY(check_counts(path, options));
  Rendering rendering = described(textures, path, options, engine);
  rendering.reasons = std::move(reasons);
  const auto texture_path = TexturePath::make(textures, path, options.ends);
  TACTO_TRY(texture_path);
  const double finest_hz = rendering.texture_highest_per_m * rendering.max_speed_mps;
  const auto grid = reading_grid(path.duration_s(), options.rate_hz, options.band, finest_hz);
  rendering.samples_outside = texture_path->count_outside(grid);
  if (rendering.samples_outside == grid.samples) return texture_path->outside_textures();
  if (grid.capped) warn_of_folding(rendering, grid, options.band);
  rendering.reading_rate_hz = grid.reading_rate_hz();
  rendering.fade_m = texture_path->fade_m();
  report(0.1);
  const auto target = texture_path->target(grid, options.band, options.gain_m_per_n, rendering.onset_s);
  report(0.8);
  warn_of_model(rendering, transducer, options.band, engine);
  const RenderJob job{textures, path, target, chain_of(transducer, options), options};
  rendering.target_m = {options.rate_hz, path.time_s.front(), signal_of(target)};
  TACTO_TRY(drive_by(engine, rendering, job));
  TACTO_TRY(keep_budget(rendering, job));
  report(1);
  return rendering;
}

Result<Rendering> render(const schema::Texture& texture, const FingerPath& path,
                         const schema::Transducer& transducer, const RenderOptions& options,
                         const std::function<void(double)>& progress) {
  const PlacedTexture placed{&texture, options.at_m, 1};
  return render(std::span(&placed, 1), path, transducer, options, progress);
}

}  // namespace tacto::playback
