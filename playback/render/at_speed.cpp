// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/at_speed.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "playback/model/chain.hpp"
#include "playback/prepare/kernel_drive.hpp"
#include "playback/render/reference/exact_drive.hpp"
#include "spatial/features/band_kept.hpp"

namespace tacto::playback {
namespace {

constexpr double kSlowestMps = 1e-3, kFastestMps = 2, kExact = 1 + 1e-4;

// The displacement rings out after the drive's end.
constexpr double kPaddingS = 1;

Peaks unlimited_peaks(const PreparedTexture& played, double gain_m_per_n, double speed_mps) {
  const double rate_hz = played.options.rate_hz, length_m = played.texture.signal.length_m();
  const double start_m = played.options.origin_m;
  const FingerPath path{{0, length_m / speed_mps}, {start_m, start_m + length_m}};
  const auto ticks = static_cast<std::size_t>(path.time_s.back() * rate_hz) + 1;
  auto drive_v = unlimited_drive(played.prepared, gain_m_per_n, path, played.options, ticks);
  const Chain chain{played.transducer, played.options.reconstruction, played.options.reconstruction_cutoff_hz,
                    played.options.hold, rate_hz};
  const PaddedSpectrum grid{rate_hz, ticks, ticks + static_cast<std::size_t>(kPaddingS * rate_hz), {}};
  Peaks peaks = modelled_from(drive_v, grid, chain).peaks;
  peaks.slew_v_per_s = peaks_of(drive_v, {}, rate_hz, played.transducer, AfterDrive::more).slew_v_per_s;
  return peaks;
}

}  // namespace

AtSpeed at_speed(const PreparedTexture& played, double gain_m_per_n, double speed_mps) {
  return {speed_mps, unlimited_peaks(played, gain_m_per_n, speed_mps).tightest(),
          spatial::band_kept_percent(played.texture, speed_mps, played.options.band)};
}

double largest_gain_at(const PreparedTexture& played, double gain_m_per_n, double speed_mps) {
  return fitting_gain(gain_m_per_n, unlimited_peaks(played, gain_m_per_n, speed_mps),
                      [&](double gain) { return unlimited_peaks(played, gain, speed_mps); });
}

std::optional<SpeedRange> playable_speeds(const PreparedTexture& played, double gain_m_per_n,
                                          double near_mps) {
  const double step = std::exp2(0.25);
  const auto can = [&](double speed_mps) {
    return speed_mps >= kSlowestMps && speed_mps <= kFastestMps &&
           at_speed(played, gain_m_per_n, speed_mps).can_be_played();
  };
  // The last speed at which it can be played, from one at which it can, towards larger or smaller ones.
  const auto last = [&](double yes, double factor) {
    double no = yes * factor;
    while (can(no)) yes = no, no *= factor;
    while (std::max(yes / no, no / yes) > kExact) {
      const double between = std::sqrt(yes * no);
      (can(between) ? yes : no) = between;
    }
    return yes;
  };
  double inside_mps = near_mps;
  if (!can(inside_mps))
    for (inside_mps = kFastestMps; inside_mps >= kSlowestMps && !can(inside_mps);) inside_mps /= step;
  if (inside_mps < kSlowestMps) return std::nullopt;
  return SpeedRange{last(inside_mps, 1 / step), last(inside_mps, step)};
}

}  // namespace tacto::playback
