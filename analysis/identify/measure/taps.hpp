// SPDX-License-Identifier: GPL-3.0-or-later
// Resonance and damping of a sensor from its ringing after taps.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// One tap: the sensor's output, beginning before the tap.
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
  double energy_part = 0;  ///< share of the ringing's energy
};

struct RingingTap {
  std::string name;
  std::vector<RingingMode> modes;  ///< the first resonance (see TapsFit) first, then by energy
  double left = 0;                 ///< RMS of the residual without the modes, over that of the ringing
};

/// Median and spread (1.4826 x the median distance from it, which is the standard deviation for Gaussian
/// scatter), the standard deviation, and the ends. A standard deviation much larger than the spread indicates
/// groups.
struct Spread {
  double median = 0, spread = 0;
  double standard_deviation = 0, least = 0, most = 0;
};

struct TapsFit {
  /// Share of the ringing that the modes explain: 1 - (left)^2, median of the taps.
  double r_squared = 0;
  std::vector<RingingTap> taps;
  Spread resonance_hz,
      damping_ratio;  ///< of the lowest mode with a fifth of the strongest's energy, over all taps
};

/// Prediction of later taps from the first ones.
struct TapsPrediction {
  std::size_t fitted = 0, predicted = 0;  ///< numbers of taps
  double resonance_error = 0;             ///< median of the others over that of the first, minus 1
  double damping_error = 0;
  /// 20 poles shared by the first taps, with amplitudes from the first quarter of each other tap's ringing:
  /// RMS error in the remaining three quarters, over the RMS there; median and largest.
  double waveform_error = 0, worst_waveform_error = 0;
  double shape_error =
      0;  ///< the same poles with amplitudes from the whole ringing: relative residual, median
};

/// Reads `impact,sample_index,lateral_V` (any first column that numbers the taps, any last column with the
/// values). Errors: those of reading a file; malformed, with the line.
schema::Result<Taps> read_taps(const std::string& path, double rate_hz);

/// Matrix pencil (Hua and Sarkar 1990) with 16 poles of 12 ms of ringing, beginning 1 ms after the largest
/// value, at a quarter of the rate (mean of four samples: the poles do not change, amplitudes decrease by
/// less than 6 % up to 5 kHz). Neighbouring poles within 3 % form one mode, weighted by energy. Errors:
/// unsuitable: fewer than two taps, a tap that is too short, one without ringing (noise), NaN.
schema::Result<TapsFit> fit_taps(const Taps& taps);

/// Fits the first `fitted` taps and compares with the others. Precondition: 0 < fitted < taps.
schema::Result<TapsPrediction> predict_taps(const Taps& taps, std::size_t fitted);

}  // namespace tacto::analysis
