// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/render_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware-host/core/kernel/profile.hpp"
#include "playback/model/limits.hpp"
#include "playback/prepare/kernel_drive.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

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

}  // namespace

// Beyond that count the kernel's output is zero (core/kernel/profile.cpp).
Result<void> check_counts(const FingerPath& path, const RenderOptions& o) {
  constexpr double kFarthestCount = 1 << 29;
  const double farthest_m = farthest_of(path);
  if (farthest_m / o.encoder_step_m < kFarthestCount) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("the path reaches {:.4g} m, which is more than 2^29 encoder counts", farthest_m),
              "--encoder-step",
              fmt::format("use {:.3g} nm or more", std::ceil(1e9 * farthest_m / kFarthestCount * 1.01)));
}

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

}  // namespace tacto::playback
