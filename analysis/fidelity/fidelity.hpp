// SPDX-License-Identifier: GPL-3.0-or-later
// The closed loop in one number: a texture, played on a device, recorded again, against what was wanted.
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
  playback::PlayOptions play;  ///< texture, device, transducer, gain, preparation; of a real device the time
  std::vector<double> speeds_mps = {50e-3};  ///< of an emulated finger
  std::function<bool()> stop_asked = [] { return false; };
};

/// One kind of tray under one drive.
struct FidelityRow {
  std::string tray;              ///< "ideal", "hysteresis 16 %" ...
  double error_db = 0;           ///< felt - wanted over wanted, once one constant shift is taken out
  double error_in_place_db = 0;  ///< without taking it out
  /// The error as a displacement sensor tells it: what is felt, recorded again. None where nothing was felt.
  std::optional<double> rerecorded_db;
  double shift_m = 0;   ///< of what was felt, along the finger's way
  double level_db = 0;  ///< power of what was felt over what was wanted
  double target_rms_m = 0, felt_rms_m = 0;
  Comparison comparison;
};

/// At one speed: the rows, and what the actuator's range, slew and band took away from the texture.
struct FidelitySpeed {
  double speed_mps = 0;
  double low_hz = 0, high_hz = 0;  ///< the band that is judged
  double band_kept_percent = 100;  ///< of the power of all that is played (band_kept.hpp)
  double drive_peak_v = 0, drive_limit_v = 0;
  std::uint64_t ticks = 0, amplitude_limited = 0, slew_limited = 0;
  std::optional<double>
      removed_db;  ///< what the limits took, re the wished drive; none where it can't be known
  double delay_left_s = 0, inverse_error_db = 0;
  std::vector<FidelityRow> rows;
  std::vector<std::string> notes;
};

struct Fidelity {
  std::string texture, device, simulated;
  std::string displacement;  ///< how it was known
  double gain_m_per_n = 0, rate_hz = 0;
  std::vector<FidelitySpeed> speeds;
};

/// On `sim:` the whole way of playback runs in emulated time (emulated_pass), and the drive of its session
/// moves the tray (integrated, at 20 kHz or more), once for each row: as the paper's equations have it; with
/// hysteresis (16 %), a second mode, a finger's load; with all three. Each is seen by a displacement sensor,
/// too. Where the URI names one of them, there is one row: what it names. Judged within the texture, 50 ms
/// and its fading millimetre from either end. On a real device the finger is somebody's, for `play.time_s`;
/// its longest stroke is judged by what the recorded drive makes of the transducer's model, which knows none
/// of these: the row says so. Errors: as play_once and compare; usage: no speed, one that is not
/// above 0 or above 10 m/s, or stopped;
/// unsuitable: a texture too short for the speed, or so long for it that more than 1e7 samples (1 GB; 500 s
/// at 20 kHz) would be felt.
schema::Result<Fidelity> fidelity(const FidelityOptions& options,
                                  const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
