// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/rows/played_speeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "data-schema/base/raised_cosine.hpp"
#include "data-schema/base/statistics.hpp"
#include "firmware-host/sim/physics/spline_noise.hpp"
#include "playback/model/hysteresis_inverse.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/prepare/texture_layout.hpp"
#include "playback/prepare/undone_chain.hpp"
#include "playback/render/reference/exact_kernel.hpp"
#include "playback/render/reference/exact_target.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {
namespace {

using playback::Ends;
using playback::FingerPath;
using playback::PaddedSpectrum;
using playback::Prepared;
using playback::PrepareOptions;

constexpr double kPlayedS = 0.8, kEndsS = 0.15, kFirstM = 5e-3;
constexpr double kPartOfLimit = 0.02;
constexpr double kReachesToPerM = 100, kReachesToHz = 4, kReachesFromHz = 10;

FingerPath path_of(const FingerMotion& way) {
  const double mean_mps = way.speed_mps;
  if (!way.wanders) return {{0, kPlayedS}, {kFirstM, kFirstM + mean_mps * kPlayedS}};
  firmware_host::SplineNoise wander(firmware_host::Random(3, 1), 0.25);
  constexpr int kKnots = 800;
  FingerPath path;
  double position_m = kFirstM;
  for (int i = 0; i <= kKnots; ++i) {
    const double time_s = kPlayedS * i / kKnots;
    path.time_s.push_back(time_s);
    path.position_m.push_back(position_m);
    position_m += mean_mps * (1 + 0.1 * wander.at(time_s)) * kPlayedS / kKnots;
  }
  return path;
}

// With so fine an encoder the rounding of its scale to 32 bits would be visible, which is not an error of the
// kernel.
void take_scale_of(FingerPath& path, const Prepared& prepared, double metres_per_count) {
  const double per_count = std::ldexp(static_cast<double>(prepared.scale.samples_per_count_q32), -32);
  for (double& position_m : path.position_m) position_m *= per_count * prepared.pitch_m / metres_per_count;
}

// Lowest frequency for the reference of this finger. Content outside of the band is neither target nor error,
// but for a slow finger the reference must begin well below the band, because its lower cut-off rings through
// the record (from 10 Hz on: 1e-3 at 25 mm/s; from 4: 3e-5).
double reaches_to_hz(const FingerPath& path) {
  return std::clamp(kReachesToPerM * playback::greatest_speed_mps(path), kReachesToHz, kReachesFromHz);
}

PaddedSpectrum target_along(const FingerPath& path, const schema::SpaceSignal& loop,
                            const PrepareOptions& o) {
  const spatial::Band beyond{reaches_to_hz(path), 1.01 * o.band.high_hz};
  const double most_m = *std::ranges::max_element(path.position_m);
  const schema::SpaceSignal unrolled = playback::unrolled_loop(loop, most_m + 10e-3);
  const double finest_hz = playback::highest_spatial_frequency(loop) * playback::greatest_speed_mps(path);
  const auto grid = playback::reading_grid(path.duration_s(), o.rate_hz, beyond, finest_hz);
  return playback::exact_target(playback::TextureLookup(unrolled, 0), path, grid, beyond, o.gain_m_per_n,
                                0.005);
}

std::vector<std::int32_t> counts_along(const FingerPath& path, const PrepareOptions& o, std::size_t ticks) {
  std::vector<std::int32_t> counts;
  for (const double position_m : playback::positions_along(path, o.rate_hz, ticks))
    counts.push_back(static_cast<std::int32_t>(std::floor(position_m / o.metres_per_count)));
  return counts;
}

std::vector<float> kernel_run(const Prepared& prepared, const std::vector<std::int32_t>& counts,
                              PlayedPart part) {
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  std::vector<float> values;
  values.reserve(counts.size());
  const float gain = prepared.gain_m_per_n;
  for (const std::int32_t count : counts)
    values.push_back(part == PlayedPart::reading ? kernel.target(count, gain)
                                                 : kernel.tick({count, gain, true, core::kNoForce}).drive_v);
  return values;
}

std::vector<float> double_run(const Prepared& prepared, const std::vector<std::int32_t>& counts) {
  playback::ExactKernel kernel(prepared);
  std::vector<float> values;
  for (const std::int32_t count : counts)
    values.push_back(static_cast<float>(kernel.tick({count, double{prepared.gain_m_per_n}, true})));
  return values;
}

std::vector<double> modelled_from(const std::vector<float>& drive_v, const schema::Transducer& transducer,
                                  const PrepareOptions& o) {
  std::vector<double> drive(drive_v.begin(), drive_v.end());
  if (transducer.hysteresis)
    drive = playback::linear_drive_of(drive, *transducer.hysteresis, schema::actuator_pole_hz(transducer),
                                      o.rate_hz);
  playback::Chain chain = playback::undone_chain(transducer, o).chain;
  chain.compensated_pole_hz = 0;
  constexpr double kSettledS = 1;  // the tray rings for 50 ms
  const std::size_t period =
      spatial::fast_length(drive.size() + static_cast<std::size_t>(kSettledS * o.rate_hz));
  return playback::signal_of(playback::through(playback::spectrum_of(drive, o.rate_hz, period),
                                               [&](double f) { return playback::chain_response(chain, f); }));
}

std::vector<double> between_ends(const std::vector<double>& values, const PrepareOptions& o) {
  const auto skipped = static_cast<std::ptrdiff_t>(kEndsS * o.rate_hz);
  std::vector<double> inner(values.begin() + skipped, values.end() - skipped);
  const auto n = static_cast<double>(inner.size());
  for (std::size_t i = 0; i < inner.size(); ++i)
    inner[i] *= 2 * schema::rising_cosine(2 * std::numbers::pi * static_cast<double>(i) / n);
  return inner;
}

PaddedSpectrum spectrum_between(const std::vector<double>& values, const PrepareOptions& o) {
  const auto inner = between_ends(values, o);
  return playback::spectrum_of(inner, o.rate_hz, inner.size());
}

double amplitude_error_re(const std::vector<double>& values, const std::vector<double>& target,
                          const PrepareOptions& o) {
  PaddedSpectrum off = spectrum_between(values, o);
  const PaddedSpectrum whole = spectrum_between(target, o);
  for (std::size_t k = 0; k < off.bins.size(); ++k)
    off.bins[k] = std::abs(off.bins[k]) - std::abs(whole.bins[k]);
  return std::sqrt(playback::energy_in(off, o.band) / playback::energy_in(whole, o.band));
}

double band_rms(const std::vector<double>& values, const PrepareOptions& o) {
  return std::sqrt(playback::energy_in(spectrum_between(values, o), o.band));
}

double error_re(const std::vector<double>& values, const std::vector<double>& target,
                const PrepareOptions& o) {
  std::vector<double> error = values;
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= target[i];
  return band_rms(error, o) / band_rms(target, o);
}

double gain_for(const schema::SpaceSignal& loop, const schema::Transducer& transducer) {
  double peak_n = 0;
  for (const double force_n : loop.values) peak_n = std::max(peak_n, std::abs(force_n));
  return peak_n > 0 ? std::min(1.0, kPartOfLimit * transducer.displacement_limit_m / peak_n) : 1e-3;
}

// By Parseval, from one half of the lines; the mean square of the window between the ends is 3/2.
double target_share(const std::vector<double>& exact, const schema::SpaceSignal& loop,
                    const PrepareOptions& o) {
  const PaddedSpectrum inner = spectrum_between(exact, o);
  const auto n = static_cast<double>(inner.period);
  const double mean_square = 2 * playback::energy_in(inner, o.band) / (1.5 * n * n);
  return std::sqrt(mean_square) / (o.gain_m_per_n * schema::rms_of(loop.values));
}

// Without a delay the target is not delayed.
double later_error_of(const PaddedSpectrum& target, const std::vector<double>& played,
                      const PrepareOptions& o, const PlayedOutcome& outcome) {
  if (outcome.delay_left_s == 0) return outcome.error;
  const auto later = playback::through(
      target, [&](double f) { return std::polar(1.0, -2 * std::numbers::pi * f * outcome.delay_left_s); });
  return error_re(played, playback::signal_of(later), o);
}

void compare_with(const PaddedSpectrum& target, const std::vector<double>& played,
                  const schema::SpaceSignal& loop, const PrepareOptions& o, PlayedOutcome& outcome) {
  const auto exact = playback::signal_of(target);
  outcome.target_part = target_share(exact, loop, o);
  outcome.error = error_re(played, exact, o);
  outcome.amplitude_error = amplitude_error_re(played, exact, o);
  outcome.later_error = later_error_of(target, played, o, outcome);
}

// With less of the texture in the band, the displacement is mainly leakage from outside of the band.
constexpr double kLeastTargetShare = 0.05;

// Plays 0.8 s of a looped texture through the modelled transducer (with its hysteresis) and compares with
// the exact reference, without 0.15 s at both ends. The target displacement peaks at a fiftieth of the
// transducer's limit, so that no limit is reached. Errors: those of prepare().
schema::Result<PlayedOutcome> play_case(const schema::Texture& texture, const schema::Transducer& transducer,
                                        const PlayedCase& played) {
  const playback::PlacedTexture placed{&texture, 0, 1};
  PrepareOptions options = played.options;
  options.ends = Ends::loop;
  options.onset_s = 0;
  TACTO_TRY(playback::check_prepare(std::span(&placed, 1), options));
  const auto loop = playback::one_period(std::span(&placed, 1), Ends::loop, options.seam_m);
  options.gain_m_per_n = gain_for(loop, transducer);
  auto made = playback::prepare(texture, transducer, options);
  TACTO_TRY(made);
  const auto prepared = std::make_shared<const Prepared>(std::move(*made));
  FingerPath path = path_of(played.way);
  const auto counts = counts_along(path, options, static_cast<std::size_t>(kPlayedS * options.rate_hz) + 1);
  take_scale_of(path, *prepared, options.metres_per_count);
  const PaddedSpectrum target = target_along(path, loop, options);
  PlayedOutcome outcome;
  outcome.ticks = static_cast<double>(counts.size());
  outcome.ticking = [prepared, counts, in_double = played.in_double] {
    (void)(in_double ? double_run(*prepared, counts) : kernel_run(*prepared, counts, PlayedPart::whole));
  };
  outcome.memory_bytes = static_cast<double>(prepared->built.sample_bytes);
  outcome.delay_left_s = prepared->delay_left_s;
  outcome.drive_v =
      played.in_double ? double_run(*prepared, counts) : kernel_run(*prepared, counts, played.part);
  const auto output = played.part == PlayedPart::reading
                          ? std::vector<double>(outcome.drive_v.begin(), outcome.drive_v.end())
                          : modelled_from(outcome.drive_v, transducer, options);
  compare_with(target, output, loop, options, outcome);
  return outcome;
}

}  // namespace

schema::Result<PlayedSpeeds> PlayedSpeeds::of(const schema::Texture& texture,
                                              const schema::Transducer& transducer, PlayedCase played,
                                              std::span<const double> speeds_mps) {
  PlayedSpeeds all;
  for (const double speed_mps : speeds_mps) {
    played.way.speed_mps = speed_mps;
    auto outcome = play_case(texture, transducer, played);
    TACTO_TRY(outcome);
    all.speeds_mps_.push_back(speed_mps);
    all.outcomes_.push_back(std::move(*outcome));
  }
  return all;
}

std::vector<ErrorAtSpeed> PlayedSpeeds::errors(double PlayedOutcome::*kind) const {
  std::vector<ErrorAtSpeed> errors;
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    const bool played = outcomes_[i].target_part >= kLeastTargetShare;
    errors.push_back({speeds_mps_[i], played ? outcomes_[i].*kind : kNotMeasured});
  }
  return errors;
}

double worst_of(std::span<const ErrorAtSpeed> errors) {
  double worst = kNotMeasured;
  for (const ErrorAtSpeed& each : errors) worst = std::fmax(worst, each.error);
  return worst;
}

std::string speed_words(std::span<const ErrorAtSpeed> errors) {
  std::string words;
  for (const ErrorAtSpeed& each : errors)
    words += fmt::format("{}{:g}", words.empty() ? "" : ", ", 1e3 * each.speed_mps);
  return words + " mm/s";
}

}  // namespace tacto::analysis
