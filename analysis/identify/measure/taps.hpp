// SPDX-License-Identifier: GPL-3.0-or-later
// A sensor's own ringing, heard after a tap.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// One tap: what the sensor gave, from before it on.
struct Tap {
  std::string name;
  std::vector<double> value;
};

struct Taps {
  double rate_hz = 0;
  std::vector<Tap> taps;
};

/// A damped sinusoid of a ringing: exp(-damping_ratio w t) at the undamped frequency w / 2 pi.
struct RingingMode {
  double frequency_hz = 0, damping_ratio = 0;
  double energy_part = 0;  ///< of the ringing that was looked at
};

struct RingingTap {
  std::string name;
  std::vector<RingingMode> modes;  ///< the first resonance (see TapsFit) first, then by energy
  double left = 0;                 ///< RMS of what the modes leave, over the ringing's own
};

/// Median and spread (1.4826 x the median distance from it: of Gaussian scatter the standard deviation), and
/// the plain standard deviation and ends: where they say more, the values stand in groups.
struct Spread {
  double median = 0, spread = 0;
  double standard_deviation = 0, least = 0, most = 0;
};

struct TapsFit {
  /// Of the ringing, what the modes explain: 1 - (left)^2, median of the taps.
  double r_squared = 0;
  std::vector<RingingTap> taps;
  Spread resonance_hz,
      damping_ratio;  ///< of the lowest mode with a fifth of the strongest's energy, over all taps
};

/// The rest of a set of taps, foretold by the first ones.
struct TapsPrediction {
  std::size_t fitted = 0, foretold = 0;  ///< taps
  double resonance_error = 0;            ///< part: the others' median over the first ones', less 1
  double damping_error = 0;
  /// 20 poles shared by the first taps, with amplitudes from the first quarter of each other tap's ringing:
  /// RMS of what they miss in its remaining three quarters, over the RMS there; median and largest.
  double waveform_error = 0, worst_waveform_error = 0;
  double shape_error =
      0;  ///< the same poles with amplitudes from the whole ringing: what they leave of it, median
};

/// Reads `impact,sample_index,lateral_V` (any first column that numbers the taps, any last one that holds the
/// values). Errors: as of reading a file; malformed, with the line.
schema::Result<Taps> read_taps(const std::string& path, double rate_hz);

/// Matrix pencil (Hua and Sarkar 1990) with 16 poles of 12 ms of ringing, beginning 1 ms after the largest
/// value, at a quarter of the rate (mean of four samples: poles stay, amplitudes fall by less than 6 % to 5
/// kHz). Neighbouring poles within 3 % are one mode, weighted by energy. Errors: unsuitable: fewer than two
/// taps, a tap too short, one without ringing (noise), NaN.
schema::Result<TapsFit> fit_taps(const Taps& taps);

/// Fitted on the first `fitted` taps, held against the others. Precondition: 0 < fitted < taps.
schema::Result<TapsPrediction> foretell_taps(const Taps& taps, std::size_t fitted);

}  // namespace tacto::analysis
