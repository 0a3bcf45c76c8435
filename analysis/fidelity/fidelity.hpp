// SPDX-License-Identifier: GPL-3.0-or-later
// Fidelity: a texture is played on a device, recorded again, and compared with the target.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/compare.hpp"
#include "data-schema/base/error.hpp"
#include "playback/player/play.hpp"

namespace tacto::analysis {

struct FidelityOptions {
  playback::PlayOptions play;  ///< texture, device, transducer, gain, preparation; real device: time
  std::vector<double> speeds_mps = {50e-3};  ///< of the emulated finger
  std::function<bool()> stop_asked = [] { return false; };
};

/// One kind of tray under one drive.
struct FidelityRow {
  std::string tray;     ///< "ideal", "hysteresis 16 %" ...
  double error_db = 0;  ///< RMS of displacement - target over RMS of target, one constant shift removed
  double error_in_place_db = 0;  ///< without removing the shift
  /// The error as a displacement sensor measures it (recorded again). Empty if no displacement was measured.
  std::optional<double> rerecorded_db;
  double shift_m = 0;   ///< of the displacement, along the finger's path
  double level_db = 0;  ///< power of the displacement over that of the target
  double target_rms_m = 0, finger_rms_m = 0;
  Comparison comparison;
};

/// The rows of one speed, and what the actuator's range, slew rate and band removed from the texture.
struct FidelitySpeed {
  double speed_mps = 0;
  double low_hz = 0, high_hz = 0;  ///< the band of the comparison
  double band_kept_percent = 100;  ///< share of the texture's power (spatial/features/band_kept.hpp)
  double gain_m_per_n = 0;
  double drive_peak_v = 0, drive_limit_v = 0;
  std::uint64_t ticks = 0, amplitude_limited = 0, slew_limited = 0;
  std::optional<double> removed_db;  ///< removed by the limits, re the unlimited drive; empty if unknown
  double delay_left_s = 0, inverse_error_db = 0;
  std::vector<FidelityRow> rows;
  std::vector<std::string> notes;
};

struct Fidelity {
  std::string texture, device, simulated;
  std::string displacement;  ///< how the displacement was obtained
  double gain_m_per_n = 0, rate_hz = 0;
  std::vector<FidelitySpeed> speeds;
};

/// On `sim:` the complete chain of playback runs in emulated time (emulated_pass). The drive of its session
/// moves the tray (integrated, at 20 kHz or more), once for each row: ideal, by the paper's equations; with
/// hysteresis (16 %); with a second mode; with a finger's load; with all three. Each displacement is also
/// measured by an emulated sensor. If the URI sets one of these effects, there is one row with exactly these.
/// The comparison excludes 50 ms and the 1 mm fade at both ends of the texture. On a real device the user
/// moves the finger for `play.time_s`. Its longest stroke is judged by the displacement that the transducer's
/// model gives for the recorded drive, without these effects; the row says so. Errors: those of play_once and
/// compare; usage: no speed, a speed that is not above 0 or is above 10 m/s, or stopped; unsuitable: a
/// texture that is too short for the speed, or so long that it gives more than 1e7 samples (1 GB; 500 s at 20
/// kHz).
schema::Result<Fidelity> fidelity(const FidelityOptions& options,
                                  const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
