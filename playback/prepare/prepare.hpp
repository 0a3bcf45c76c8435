// SPDX-License-Identifier: GPL-3.0-or-later
// From textures, a transducer and an encoder to the data of the tick kernel, for this process or a device.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/playback_defaults.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/core/kernel/tick_kernel.hpp"
#include "playback/model/chain.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

// Counts the levels, filters and other parts that were built for a playback.

/// The counters of what a scene does not name stay at 0.
struct ConstructionTally {
  std::size_t texture_files = 0;    ///< read
  std::size_t textures_placed = 0;  ///< on the encoder's axis
  std::size_t seams = 0;            ///< of loops, faded
  std::size_t levels = 0;           ///< transformed
  std::size_t sample_bytes = 0;     ///< of all levels
  std::size_t filters = 0;          ///< by least squares; a gain alone is none
  std::size_t taps = 0;             ///< including the single one of a gain
  std::size_t hysteresis = 0;       ///< operators inverted
  std::size_t play_operators = 0;   ///< of the inverted hysteresis
  std::size_t sections = 0;         ///< recursive
  std::size_t energy_limits = 0;
  std::size_t touch_gates = 0;
  std::size_t following = 0;  ///< look-aheads and timings of edges
};

struct Prepared;

/// A part that was not built, and why.
struct LeftOut {
  std::string part, because;
};
std::vector<LeftOut> left_out_of(const Prepared& prepared);

/// A texture and the place of its position 0 on the encoder's axis.
struct PlacedTexture {
  const schema::Texture* texture = nullptr;
  double at_m = 0;
  double weight = 1;  ///< factor of the common gain
};

/// What is beyond the texture. stop: nothing; the last millimetre fades (TextureLookup). loop: it is
/// repeated, unchanged if its end meets its beginning (seam_of_loop()); otherwise its last millimetre is cut
/// off and fades into the first. mirror: it is reversed.
using Ends = wire::ProfileEnds;

/// Time over which the tracker averages the speed if counts come in every tick.
inline constexpr double kTrackerS = 2e-3;

struct PrepareOptions {
  double rate_hz = 2e3;            ///< of ticks; Wiertlewski 2011 plays at 2 kHz
  double metres_per_count = 1e-6;  ///< of the encoder
  std::int32_t origin_count = 0;   ///< the encoder's count at origin_m
  double origin_m = 0;
  double gain_m_per_n = 1e-3;  ///< G_psi, m/N; live: TickInput::gain
  spatial::Band band;          ///< unchanged up to its upper edge, if the rate permits
  Ends ends = Ends::stop;
  double seam_m = schema::kSeamM;  ///< of a loop whose end does not meet its beginning; 0: none
  wire::Interpolation interpolation = wire::Interpolation::hermite;
  double samples_per_period = 0;  ///< of the finest content; 0: default of the interpolation (pyramid_shape)
  Inverse inverse = Inverse::full;
  Reconstruction reconstruction = Reconstruction::none;
  double reconstruction_cutoff_hz = 600;
  Hold hold = Hold::zero_order;
  bool undo_hysteresis = true;     ///< if the transducer's file has a hysteresis
  double delay_s = 2e-3;           ///< of the inverse (magnitude, full)
  std::uint16_t inverse_taps = 0;  ///< 0: 3.2 ms of them, 24 to 128
  double loop_delay_s = 0;         ///< of a loop closed elsewhere: from the count to the drive at the device
  bool look_ahead = true;          ///< read at the predicted place after both delays
  bool between_counts = true;      ///< time the encoder's edges
  double max_speed_mps = 0.5;      ///< no aliasing up to it; beyond, the texture fades to silence
  double jump_mps = 0;             ///< a faster change of the count is a fault; 0: four times max_speed_mps
  double onset_s = schema::kOnsetS, release_s = schema::kReleaseS;
  std::uint16_t watchdog_ms = 100;
  double energy_rms_v = 0, energy_window_s = 1;  ///< limit of the drive's RMS; 0: none
  /// Normal force, N, at which contact begins and below which it ends; 0: no gate.
  double contact_on_n = 0, contact_off_n = 0;
  std::size_t most_samples = std::size_t{1} << 24;  ///< of all levels: profile_samples of a device
};

/// All data of the kernel, owned by this; and figures of it.
struct Prepared {
  std::vector<float> samples;  ///< of all levels, N
  core::ProfileScale scale;
  std::vector<float> taps;          ///< V for m
  wire::Hysteresis play_operators;  ///< inverse of the bender's hysteresis; none: straight 1
  std::vector<wire::Section> sections;
  core::TrackerSetup tracker;
  wire::Limits limits;
  double rate_hz = 0;
  float gain_m_per_n = 0;
  float full_detail_counts_per_tick = 0;
  float energy_rms_v = 0, energy_window_s = 0, gate_on_n = 0, gate_off_n = 0;

  double delay_s = 0;           ///< from the tick to the displacement, as designed
  double delay_left_s = 0;      ///< the part that looking ahead does not compensate
  double passes_to_hz = 0;      ///< the band's upper edge; below band.high_hz at rates below 2 kHz
  double stops_at_hz = 0;       ///< nothing is played beyond it, up to max_speed_mps
  double inverse_error_db = 0;  ///< RMS over the band of |chain x inverse - delay|, as designed
  double inverse_gain_db = 0;   ///< the inverse's largest gain, re its gain at rest
  double beyond_band_db = 0;    ///< largest |chain x inverse| from passes_to_hz to stops_at_hz
  double finest_per_m = 0;      ///< the highest spatial frequency that is kept of the texture
  double pitch_m = 0;           ///< of the first level
  double loop_period_m = 0;     ///< period of a looped texture; 0: no loop
  double loop_seam_m = 0;       ///< the length cut off its end, which fades into its beginning
  std::vector<std::string> notes;
  ConstructionTally built;

  std::uint32_t rate_millihertz() const { return static_cast<std::uint32_t>(std::llround(1e3 * rate_hz)); }
  /// Points into this, which must not move and must outlive the kernel.
  core::KernelSetup setup() const;
};

/// Offline, double precision. Several textures are placed on one path and added (ends: stop only).
///
/// Levels: level n passes spatial frequencies up to finest / 2^(n/2) unchanged and falls to zero at 1.25
/// times that by a raised cosine (by Fourier transform: nothing remains beyond). At a speed v the kernel
/// fades between two levels that both contain everything up to passes_to_hz / v and nothing beyond 2.5 times
/// that (stops_at_hz). So nothing aliases into the band at rates of 3.5 passes_to_hz and more.
///
/// Inverse: a finite filter g by least squares over frequency, |chain g - exp(-2 pi i f delay)|^2 in the
/// band, |chain g|^2 beyond stops, and |g|^2 with the smallest weight that keeps |g| within 20 dB of its
/// value at rest.
///
/// Hysteresis: if the transducer's file has it, the filter gives the target charge of the bender, play
/// operators invert the hysteresis of that charge, and a section compensates the amplifier's low-pass. Exact
/// if the bender is as in the file and there is no reconstruction filter before it; such a filter loses the
/// corners of the drive.
///
/// Errors: usage, for options out of range; unsuitable, for a transducer whose inverse has a residual of over
/// a tenth (full, magnitude), for a texture that is not force in N, has fewer than 2 samples or one that is
/// not finite, or needs more than most_samples (with how many).
schema::Result<Prepared> prepare(std::span<const PlacedTexture> textures,
                                 const schema::Transducer& transducer, const PrepareOptions& options);

/// Checks the arguments of prepare() without preparing. Errors: as prepare().
schema::Result<void> check_prepare(std::span<const PlacedTexture> textures, const PrepareOptions& options);

/// What to do with a texture that needs more samples than there is memory, with this interpolation.
std::string ways_to_fit(wire::Interpolation interpolation);

/// A single texture.
inline schema::Result<Prepared> prepare(const schema::Texture& texture, const schema::Transducer& transducer,
                                        const PrepareOptions& options, double at_m = 0) {
  const PlacedTexture placed{&texture, at_m, 1};
  return prepare(std::span(&placed, 1), transducer, options);
}

}  // namespace tacto::playback
