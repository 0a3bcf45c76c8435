// SPDX-License-Identifier: GPL-3.0-or-later
// The effect of the encoder's step at constant speed, by the position within a count at which the finger
// begins (its phase). At a speed of whole counts per tick no edge is between two ticks, so the kernel knows
// the position only to half a count: the playback has a constant shift that depends on the phase. At half
// counts per tick it is a quarter of a count. Besides the error in place, this computes the error after
// removal of that shift, by the function that `fidelity` uses.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/compare/band_sums.hpp"
#include "analysis/compare/cross_spectrum.hpp"
#include "firmware-host/sim/physics/random.hpp"
#include "tests/playback/fidelity.hpp"

namespace tacto::tests {

struct PhaseError {
  double in_place_db = 0, error_um = 0;  ///< as Fidelity has them
  double shifted_db = 0;                 ///< after removal of one constant shift
  double shift_um = 0;                   ///< of the tray, along the finger's path
};

/// The distance of the finger from one tick to the next, in counts.
enum class CountsATick { any, whole, half };

/// From 25 to 200 mm/s, evenly spaced on a logarithmic axis, m/s.
inline std::vector<double> drawn_speeds(CountsATick kind, std::size_t number, double count_m, double rate_hz,
                                        firmware_host::Random& random) {
  constexpr double kSlowestMps = 0.025, kFastestMps = 0.2;
  std::vector<double> speeds;
  while (speeds.size() < number) {
    const double drawn_mps = kSlowestMps * std::pow(kFastestMps / kSlowestMps, random.uniform());
    double counts = drawn_mps / (count_m * rate_hz);
    if (kind == CountsATick::whole) counts = std::round(counts);
    if (kind == CountsATick::half) counts = std::floor(counts) + 0.5;
    if (const double mps = counts * count_m * rate_hz; mps >= kSlowestMps && mps <= kFastestMps)
      speeds.push_back(mps);
  }
  return speeds;
}

/// In counts. The first two are just behind an edge and just behind the middle, with the largest shifts. None
/// is exactly on an edge, where the rounding of each position decides which count is read.
inline std::vector<double> drawn_phases(std::size_t number, firmware_host::Random& random) {
  std::vector<double> phases = {0.001, 0.501};
  while (phases.size() < number) phases.push_back(random.uniform());
  return phases;
}

/// At one speed, in the order of the phases.
struct PhaseErrors {
  std::vector<PhaseError> errors;

  /// Range of the error without the shift over the phases.
  double spread_db() const {
    const auto [least, most] = std::ranges::minmax(errors, {}, &PhaseError::shifted_db);
    return most.shifted_db - least.shifted_db;
  }
};

/// One texture, looped, at one rate. The target at another phase is the target at phase 0, earlier by phase x
/// count / speed.
class EvenPass {
 public:
  static constexpr double kDurationS = 1.4, kStartM = 0.02;

  static schema::Result<EvenPass> make(const schema::Texture& texture, FidelityCase c) {
    const playback::PlacedTexture placed{&texture, 0, 1};
    c.options.ends = playback::Ends::loop;
    auto prepared = playback::prepare(std::span(&placed, 1), c.model, c.options);
    TACTO_TRY(prepared);
    return EvenPass(c, std::move(*prepared),
                    playback::one_period(std::span(&placed, 1), playback::Ends::loop, c.options.seam_m));
  }

  /// The speed of the following passes.
  void set_speed(double speed_mps) {
    const spatial::Band reference{10, case_.options.band.high_hz * 1.01};
    const playback::FingerPath path{{0, kDurationS}, {kStartM, kStartM + speed_mps * kDurationS}};
    const auto unrolled = playback::unrolled_loop(loop_, path.position_m.back() + 0.01);
    const auto grid =
        playback::reading_grid(kDurationS, fine_rate_hz(), reference, finest_per_m_ * speed_mps);
    const playback::TextureLookup lookup(unrolled, 0);
    target_ = playback::exact_target(lookup, path, grid, reference, case_.options.gain_m_per_n, 0.005);
    speed_mps_ = speed_mps;
  }

  PhaseErrors errors_at(const std::vector<double>& phases) {
    PhaseErrors found;
    for (const double phase : phases) found.errors.push_back(error_at(phase));
    return found;
  }
  PhaseError error_at(double phase) {
    const double ahead_m = phase * case_.options.metres_per_count;
    case_.path = {{0, kDurationS}, {kStartM + ahead_m, kStartM + ahead_m + speed_mps_ * kDurationS}};
    auto target = playback::signal_of(earlier(ahead_m / speed_mps_));
    const auto played = displacement_at_finger(case_, prepared_, target.size() / fine_, fine_);
    target.resize(played.size());
    return compared(target, played);
  }

 private:
  EvenPass(FidelityCase c, playback::Prepared prepared, schema::SpaceSignal loop)
      : case_(std::move(c)),
        prepared_(std::move(prepared)),
        loop_(std::move(loop)),
        finest_per_m_(playback::highest_spatial_frequency(loop_)),
        fine_(static_cast<std::size_t>(std::ceil(20e3 / case_.options.rate_hz))) {}

  double fine_rate_hz() const { return case_.options.rate_hz * static_cast<double>(fine_); }

  playback::PaddedSpectrum earlier(double time_s) const {
    return playback::through(
        target_, [time_s](double hz) { return std::polar(1.0, 2 * std::numbers::pi * hz * time_s); });
  }

  PhaseError compared(const std::vector<double>& target, const std::vector<double>& played) const {
    const auto skipped = static_cast<std::size_t>(kLeftOutS * fine_rate_hz());
    const std::size_t judged = target.size() - 2 * skipped;
    const auto& band = case_.options.band;
    const auto mean = analysis::mean_of(analysis::segment_spectra(
        std::span(target).subspan(skipped, judged), std::span(played).subspan(skipped, judged), true,
        1 / fine_rate_hz(), judged, band.low_hz, band.high_hz));
    const auto sums = analysis::band_sums(mean, band.low_hz, band.high_hz);
    const double two_counts_s = 2 * case_.options.metres_per_count / speed_mps_;
    const auto shifted = analysis::shifted_error(mean, band.low_hz, band.high_hz, two_counts_s);
    const double error_m = std::sqrt(sums.aa) * std::pow(10, sums.error_db() / 20);
    return {sums.error_db(), 1e6 * error_m, shifted.error_db, 1e6 * shifted.shift * speed_mps_};
  }

  FidelityCase case_;
  playback::Prepared prepared_;
  schema::SpaceSignal loop_;
  double finest_per_m_;
  std::size_t fine_;
  playback::PaddedSpectrum target_;
  double speed_mps_ = 0;
};

}  // namespace tacto::tests
