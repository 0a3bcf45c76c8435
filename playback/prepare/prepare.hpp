// SPDX-License-Identifier: GPL-3.0-or-later
// From textures, a transducer and an encoder to what the tick kernel runs: in process, or on the device.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/core/kernel/tick_kernel.hpp"
#include "playback/model/chain.hpp"
#include "playback/prepare/construction_tally.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// A texture and where its position 0 lies on the encoder's axis.
struct PlacedTexture {
  const schema::Texture* texture = nullptr;
  double at_m = 0;
  double weight = 1;  ///< times the gain of all
};

/// What the finger feels beyond the texture. stop: nothing; the last millimetre fades (TextureLookup).
/// loop: it begins again, as it is where its end meets its beginning (seam_of_loop()); else without its last
/// millimetre, which fades into the first. mirror: it comes back.
using Ends = wire::ProfileEnds;

/// Over which the tracker averages speed where counts come every tick.
inline constexpr double kTrackerS = 2e-3;

struct PrepareOptions {
  double rate_hz = 2e3;            ///< of ticks; Wiertlewski 2011 plays at 2 kHz
  double metres_per_count = 1e-6;  ///< of the encoder
  std::int32_t origin_count = 0;   ///< the encoder's count at origin_m
  double origin_m = 0;
  double gain_m_per_n = 1e-3;  ///< G_psi, m/N; live: TickInput::gain
  spatial::Band band;          ///< its upper edge is kept whole, where the rate can
  Ends ends = Ends::stop;
  double seam_m = 1e-3;  ///< of a loop whose end does not meet its beginning; 0: never
  wire::Interpolation interpolation = wire::Interpolation::hermite;
  double samples_per_period = 0;  ///< of the finest content; 0: usual for the interpolation (pyramid_shape)
  Inverse inverse = Inverse::full;
  Reconstruction reconstruction = Reconstruction::none;
  double reconstruction_cutoff_hz = 600;
  Hold hold = Hold::zero_order;
  bool undo_hysteresis = true;     ///< of a transducer that says what hysteresis it has
  double delay_s = 2e-3;           ///< that the inverse may take (magnitude, full)
  std::uint16_t inverse_taps = 0;  ///< of it; 0: 3.2 ms of them, 24 to 128
  double loop_delay_s = 0;         ///< of a loop closed elsewhere: from the count to the drive at the device
  bool look_ahead = true;          ///< read where the finger will be after both delays
  bool between_counts = true;      ///< time the encoder's edges
  double max_speed_mps = 0.5;      ///< up to which nothing folds; beyond, the texture fades to silence
  double jump_mps = 0;             ///< beyond it the encoder has jumped, a fault; 0: four times max_speed_mps
  double onset_s = 0.05, release_s = 0.01;
  std::uint16_t watchdog_ms = 100;
  double energy_rms_v = 0, energy_window_s = 1;  ///< RMS of the drive that is kept; 0: no such limit
  /// Normal force, N, from which on there is a drive and below which there is none any more; 0: not gated.
  double contact_on_n = 0, contact_off_n = 0;
  std::size_t most_samples = std::size_t{1} << 24;  ///< of all levels: a device's profile_samples
};

/// All that the kernel needs, owned; and what was made, in numbers.
struct Prepared {
  std::vector<float> samples;  ///< of all levels, N
  core::ProfileScale scale;
  std::vector<float> taps;          ///< V for m
  wire::Hysteresis play_operators;  ///< that undo the bender's; none: straight 1
  std::vector<wire::Section> sections;
  core::TrackerSetup tracker;
  wire::Limits limits;
  double rate_hz = 0;
  float gain_m_per_n = 0;
  float full_detail_counts_per_tick = 0;
  float energy_rms_v = 0, energy_window_s = 0, gate_on_n = 0, gate_off_n = 0;

  double delay_s = 0;           ///< of the displacement behind the tick, as designed
  double delay_left_s = 0;      ///< of it, what looking ahead does not take back
  double passes_to_hz = 0;      ///< the band's upper edge; below band.high_hz at rates below 2 kHz
  double stops_at_hz = 0;       ///< beyond which nothing is played up to max_speed_mps
  double inverse_error_db = 0;  ///< RMS over the band of |chain x inverse - delay|, as designed
  double inverse_gain_db = 0;   ///< the inverse's largest gain, re its gain at rest
  double beyond_band_db = 0;    ///< largest |chain x inverse| from passes_to_hz to stops_at_hz
  double finest_per_m = 0;      ///< the texture's highest spatial frequency that is kept
  double pitch_m = 0;           ///< of the first level
  double loop_period_m = 0;     ///< after which a looped texture begins again; 0: no loop
  double loop_seam_m = 0;       ///< of its length, what was cut off its end and fades into its beginning
  std::vector<std::string> notes;
  ConstructionTally built;

  std::uint32_t rate_millihertz() const { return static_cast<std::uint32_t>(std::llround(1e3 * rate_hz)); }
  /// Pointers into this: it must stay where it is, and outlive the kernel's use.
  core::KernelSetup setup() const;
};

/// Offline, double precision. Several textures are laid on one path and added (ends: stop only).
///
/// Levels: level n passes spatial frequencies up to finest / 2^(n/2) whole and falls to nothing at 1.25 times
/// that by a raised cosine (by Fourier transform: nothing is left beyond). At a speed v the kernel fades
/// between two levels that both hold all up to passes_to_hz / v and nothing beyond 2.5 times that
/// (stops_at_hz): so nothing folds into the band from rates of 3.5 passes_to_hz up.
///
/// Inverse: a finite filter g by least squares over frequency, |chain g - exp(-2 pi i f delay)|^2 in the
/// band, |chain g|^2 beyond stops, and |g|^2 with the smallest weight that keeps |g| within 20 dB of its
/// value at rest.
///
/// Hysteresis: where the transducer's file has it, the filter gives what the bender is to be charged to,
/// plays undo the hysteresis of that charge, and a section undoes the amplifier's low-pass. Exact for a
/// bender that is what the file says and has no reconstruction filter before it; with one, the drive's
/// corners are lost.
///
/// Errors: usage, for options out of range; unsuitable, for a transducer whose inverse leaves more than a
/// tenth (full, magnitude), for a texture that isn't force in N, has fewer than 2 samples or one that is no
/// number, or needs more than most_samples (with how many).
schema::Result<Prepared> prepare(std::span<const PlacedTexture> textures,
                                 const schema::Transducer& transducer, const PrepareOptions& options);

/// What prepare() asks of its arguments by themselves. Errors: as of prepare().
schema::Result<void> check_prepare(std::span<const PlacedTexture> textures, const PrepareOptions& options);

/// What to do with a texture that takes more samples than there is room for, read in this way.
std::string ways_to_fit(wire::Interpolation interpolation);

/// One texture at a place.
inline schema::Result<Prepared> prepare(const schema::Texture& texture, const schema::Transducer& transducer,
                                        const PrepareOptions& options, double at_m = 0) {
  const PlacedTexture placed{&texture, at_m, 1};
  return prepare(std::span(&placed, 1), transducer, options);
}

}  // namespace tacto::playback
