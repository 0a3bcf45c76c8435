// SPDX-License-Identifier: GPL-3.0-or-later
// A texture played along a finger's path, offline: the drive that makes the tray move as the texture asks.
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
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// What to do with a drive that passes a limit of the transducer.
enum class OverLimit { refuse, clip };

/// Who computes the drive: the slow exact reference, or the kernel that runs in real time.
enum class Engine { reference, kernel };

/// Unless told. The kernel's, as `play` has it, is the drive's own: in less its slew is what the device would
/// cut.
inline constexpr double kReferenceOnsetS = 0.005, kKernelOnsetS = 0.02;

struct RenderOptions {
  double rate_hz = 10e3;       ///< of the drive; Wiertlewski 2011 records at 10 kHz
  double gain_m_per_n = 1e-3;  ///< G_psi: displacement for force. A fingertip has about 1e3 N/m
  double at_m = 0;             ///< of one texture: where its position 0 lies on the path's axis
  Ends ends = Ends::stop;      ///< what lies beyond it, of one texture
  spatial::Band band;          ///< of the displacement
  Inverse inverse = Inverse::full;
  Reconstruction reconstruction = Reconstruction::none;
  double reconstruction_cutoff_hz = 600;
  Hold hold = Hold::none;
  OverLimit over_limit = OverLimit::refuse;
  Engine engine = Engine::reference;
  double encoder_step_m = 1e-6;                                      ///< of the kernel's encoder
  wire::Interpolation interpolation = wire::Interpolation::hermite;  ///< the kernel's
  double energy_rms_v = 0, energy_window_s = 1;                      ///< the kernel's; 0: no such limit
  bool undo_hysteresis = true;  ///< by the kernel, of a transducer that says what hysteresis it has
  TickBudget budget;            ///< what the rendering has to keep, see render()
  bool keep_engine = false;     ///< the engine was named: it stays
  /// Fade at the ends of the path, at most a quarter of it; kReferenceOnsetS or kKernelOnsetS unless told.
  /// The reference's is a raised cosine of the force at either end, the kernel's its drive's onset: nothing
  /// starts with a jump where the finger starts inside the texture. What is left is the ringing of the band's
  /// edges: on a real finger's texture the drive starts below 0.3 of its RMS, without an onset at up to 1.3
  /// of it.
  std::optional<double> onset_s;
};

/// What the limits took away from a clipped drive.
struct Clipping {
  std::size_t samples = 0;     ///< drive samples that differ by more than 1e-6 of the wished peak
  double peak_reduced_db = 0;  ///< wished peak drive over the clipped one
  double removed_db = 0;       ///< RMS of what was removed, re RMS of the wished drive
};

struct Rendering {
  schema::TimeSignal drive_v;     ///< rounded to 32-bit float, as it is stored and played
  schema::TimeSignal target_m;    ///< gain x force along the path, in the band (keep_band)
  schema::TimeSignal modelled_m;  ///< drive_v through the transducer's model and hysteresis, all frequencies
  double error_db = 0;  ///< RMS of modelled - wanted in the band, re RMS of wanted; from drive_v as it is
  /// The same without the path's ends (error_between_ends), left_out_at_ends_s of each; none where nothing is
  /// wanted in between.
  std::optional<double> interior_error_db;
  /// Of the displacement behind the wanted one. The reference has none, its inverse is applied to spectra;
  /// the kernel looks ahead by what its filter takes.
  double delay_s = 0;
  Peaks peaks;  ///< of the drive and the modelled displacement, against the limits
  std::optional<Clipping> clipping;
  std::size_t samples_outside = 0;  ///< of the drive, where the finger is beside the texture
  double max_speed_mps = 0;
  double highest_passed_per_m = 0;   ///< band.high_hz / max_speed: finer content is out of the band there
  double texture_highest_per_m = 0;  ///< highest_spatial_frequency() of the texture
  double reading_rate_hz = 0;        ///< at which the texture was read along the path
  double fade_m = 0;                 ///< TextureLookup::fade_m
  double loop_period_m = 0;          ///< after which a looped texture begins again; 0: no loop
  double loop_seam_m = 0;            ///< of its end, what fades into its beginning (seam_of_loop)
  double onset_s = 0;                ///< as used
  std::vector<std::string> warnings;
  Engine engine = Engine::reference;     ///< that made the drive
  std::vector<std::string> reasons;      ///< why it was chosen, where a budget asked for it
  std::optional<TickDecision> decision;  ///< of the kernel's budget
  /// Of the kernel's drive: turned down to hold its RMS, and what all limits took away, re the drive's RMS;
  /// none: nothing.
  std::uint64_t energy_limited_samples = 0;
  std::optional<double> removed_db;
};

/// Renders in double precision, or (engine) by the tick kernel, as it would run: single precision, position
/// from an encoder, limits held. All signals share the path's time axis. `progress` hears 0 to 1.
///
/// A budget is kept as measured, by error_between_ends(): the reference is exact, and cheaper than the
/// kernel, whose error is measured against it, so it is taken unless the engine is named, max_tick_ns asks
/// for ticks, or a hysteresis is to be undone. The kernel's reading and inverse are decide()'s; where its
/// measured error is beyond the asked one (the finger's encoder, its turns), the reference takes over, with a
/// warning; a kernel that was named stays, and the error is refused.
///
/// Several textures add up, each times its weight. Beyond its ends one may be looped or mirrored, as
/// prepare() does it: then it is known to within 2^24 samples of the path.
///
/// Errors: usage, for options out of range (rate <= 2 band.high_hz, 0 < low < high, gain, onset not finite);
/// unsuitable, for a texture that isn't force in N, a path that check_finger_path() refuses, that never meets
/// the texture, that is shorter than one period of the band's lowest frequency or too long to render at once,
/// for ends of several textures that are not stop, for displacement or drive beyond a limit (see
/// check_limits), for an error that is not kept; and as decide(). Not for the tick: allocates, and plans
/// Fourier transforms. Source: Wiertlewski, Lozada, Hayward 2011, equations (5), (6) inverted in the
/// frequency domain.
schema::Result<Rendering> render(std::span<const PlacedTexture> textures, const FingerPath& path,
                                 const schema::Transducer& transducer, const RenderOptions& options,
                                 const std::function<void(double)>& progress = {});

/// One texture at options.at_m.
schema::Result<Rendering> render(const schema::Texture& texture, const FingerPath& path,
                                 const schema::Transducer& transducer, const RenderOptions& options,
                                 const std::function<void(double)>& progress = {});

}  // namespace tacto::playback
