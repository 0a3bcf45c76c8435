// SPDX-License-Identifier: GPL-3.0-or-later
// Renders a texture along a finger's path, offline: the drive with which the tray follows the target.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "playback/choose/budget.hpp"
#include "playback/model/chain.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/model/limits.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/render/reference/padded_spectrum.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// What to do with a drive that exceeds a limit of the transducer.
enum class OverLimit { refuse, clip };

/// The engine: the slow exact reference, or the kernel that runs in real time.
enum class Engine { reference, kernel };

struct RenderOptions {
  double rate_hz = 10e3;               ///< of the drive; Wiertlewski 2011 records at 10 kHz
  double gain_m_per_n = 1e-3;          ///< G_psi: displacement for force. A fingertip has about 1e3 N/m
  double default_gain_m_per_n = 1e-3;  ///< for messages: what a factor of 1 stands for
  double at_m = 0;                     ///< of a single texture: place of its position 0 on the path's axis
  Ends ends = Ends::stop;              ///< beyond a single texture
  spatial::Band band;                  ///< of the displacement
  Inverse inverse = Inverse::full;
  Reconstruction reconstruction = Reconstruction::none;
  double reconstruction_cutoff_hz = 600;
  Hold hold = Hold::none;
  OverLimit over_limit = OverLimit::refuse;
  Engine engine = Engine::reference;
  double encoder_step_m = 1e-6;                                      ///< of the kernel's encoder
  wire::Interpolation interpolation = wire::Interpolation::hermite;  ///< the kernel's
  double energy_rms_v = 0, energy_window_s = 1;                      ///< the kernel's; 0: no such limit
  bool undo_hysteresis = true;  ///< by the kernel, if the transducer's file has a hysteresis
  TickBudget budget;            ///< what the rendering has to keep; see render()
  bool keep_engine = false;     ///< the engine was named and is not changed
  /// Fade at the ends of the path, at most a quarter of it; default kReferenceOnsetS or schema::kOnsetS. The
  /// reference fades the force by a raised cosine at each end; the kernel's is an envelope of the drive, as
  /// in `play`: if it were shorter, the device would limit the slew. So there is no step if the finger starts
  /// inside the texture. The rest is the ringing of the band's edges:
  /// on a real finger's texture the drive starts below 0.3 of its RMS, without an onset at up to 1.3 of it.
  std::optional<double> onset_s;
};

/// What the limits removed from a clipped drive.
struct Clipping {
  std::size_t samples = 0;     ///< drive samples changed by more than 1e-6 of the unlimited peak
  double peak_reduced_db = 0;  ///< unlimited peak drive over the clipped one
  double removed_db = 0;       ///< RMS of the removed part, re RMS of the unlimited drive
};

struct Rendering {
  schema::TimeSignal drive_v;     ///< rounded to 32-bit float, as it is stored and played
  schema::TimeSignal target_m;    ///< gain x force along the path, in the band (keep_band)
  schema::TimeSignal modelled_m;  ///< drive_v through the transducer's model and hysteresis, all frequencies
  double error_db = 0;  ///< RMS of modelled - target in the band, re RMS of the target; from drive_v
  /// The same without the path's ends (error_between_ends), left_out_at_ends_s at each end; none if the
  /// target is zero in between.
  std::optional<double> interior_error_db;
  /// Delay of the displacement relative to the target. The reference has none, as it applies its inverse to
  /// spectra; the kernel compensates its filter's delay by looking ahead.
  double delay_s = 0;
  Peaks peaks;  ///< of the drive and the modelled displacement, with their limits
  std::optional<Clipping> clipping;
  std::size_t samples_outside = 0;  ///< of the drive, with the finger outside the texture
  double max_speed_mps = 0;
  double highest_passed_per_m = 0;  ///< band.high_hz / max_speed: finer content leaves the band at that speed
  double texture_highest_per_m = 0;  ///< highest_spatial_frequency() of the texture
  double reading_rate_hz = 0;        ///< at which the texture was read along the path
  double fade_m = 0;                 ///< TextureLookup::fade_m
  double loop_period_m = 0;          ///< period of a looped texture; 0: no loop
  double loop_seam_m = 0;            ///< the part of its end that fades into its beginning (seam_of_loop)
  double onset_s = 0;                ///< as used
  std::vector<std::string> warnings;
  Engine engine = Engine::reference;     ///< that made the drive
  std::vector<std::string> reasons;      ///< why it was chosen, if a budget asked for it
  std::optional<TickDecision> decision;  ///< of the kernel's budget
  /// For the kernel's drive: samples reduced to keep the RMS limit; and the RMS of what all limits removed,
  /// re the drive's RMS; none: nothing was removed.
  std::uint64_t energy_limited_samples = 0;
  std::optional<double> removed_db;
};

/// Renders in double precision, or (engine) with the tick kernel as it would run: single precision, position
/// from an encoder, with limits. All signals have the path's time axis. `progress` receives 0 to 1.
///
/// The budget applies to the measured error, error_between_ends(). The reference is exact, and cheaper than
/// the kernel, whose error is measured against it. So the reference is used unless the engine is named,
/// max_tick_ns is given, or a hysteresis has to be inverted. decide() chooses the kernel's interpolation and
/// inverse. If the kernel's measured error exceeds the budget (because of the encoder or changes of
/// direction), the reference replaces it, with a warning; a kernel that was named is refused.
///
/// Several textures are added, each times its weight. A single texture may be looped or mirrored beyond its
/// ends, as in prepare(), up to 2^24 samples along the path.
///
/// Errors: usage, for options out of range (rate <= 2 band.high_hz, 0 < low < high, gain, onset not finite);
/// unsuitable, for a texture that is not force in N, a path that check_finger_path() refuses, that never
/// reaches the texture, that is shorter than one period of the band's lowest frequency or too long to render
/// at once, for ends other than stop with several textures, for displacement or drive beyond a limit (see
/// check_limits), for an error beyond the budget; and as decide(). Not for the tick: allocates, and plans
/// Fourier transforms. Source: Wiertlewski, Lozada, Hayward 2011, equations (5), (6) inverted in the
/// frequency domain.
schema::Result<Rendering> render(std::span<const PlacedTexture> textures, const FingerPath& path,
                                 const schema::Transducer& transducer, const RenderOptions& options,
                                 const std::function<void(double)>& progress = {});

/// One texture at options.at_m.
schema::Result<Rendering> render(const schema::Texture& texture, const FingerPath& path,
                                 const schema::Transducer& transducer, const RenderOptions& options,
                                 const std::function<void(double)>& progress = {});

/// Duration left out at each end: 1 s, or the onset if that is longer; at most a quarter of the rendering. If
/// the finger moves at an end of its path, there is a step, which no drive in the band can follow.
double left_out_at_ends_s(const Rendering& rendering);

/// RMS over the band of modelled - target, re that of the target, 1; without left_out_at_ends_s() at each
/// end. NaN if the target is zero in between.
double error_between_ends(const Rendering& rendering, const PaddedSpectrum& target,
                          const spatial::Band& band);

}  // namespace tacto::playback
