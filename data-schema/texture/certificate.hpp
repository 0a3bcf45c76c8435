// SPDX-License-Identifier: GPL-3.0-or-later
// The speed certificate of a texture: which of its peaks belong to the surface, and which to time.
#pragma once

#include <string>
#include <vector>

namespace tacto::schema {

/// spatial: stays in 1/m while the speed changes, so it is the surface's. temporal: stays in Hz: a resonance,
/// mains.
enum class PeakVerdict { spatial, temporal, undecided };

/// A peak as it lies in the texture that holds the certificate.
struct CertifiedPeak {
  PeakVerdict verdict = PeakVerdict::undecided;
  double confidence = 0;  ///< probability of the verdict; of the likelier one where undecided
  /// Why it is undecided: "speed_ratio" (too small for the resolution), "signal_to_noise", "outside_band" (no
  /// other texture knows the place where the likelier hypothesis puts it), "both_fit", "neither_fits"; else
  /// empty.
  std::string reason;
  double frequency_per_m = 0;     ///< in this texture
  double frequency_hz = 0;        ///< at this texture's mean speed
  double rms = 0;                 ///< of a sine of its power, where it was strongest; in the texture's unit
  double snr_db = 0;              ///< over the background, where it was strongest
  double snr_needed_db = 0;       ///< what noise alone reaches in one cell of 10,000
  double speed_ratio = 0;         ///< largest between two textures that know its place
  double speed_ratio_needed = 0;  ///< from which on the two hypotheses lie a resolution apart
  std::vector<std::string> found_in;  ///< names of textures
};

struct Certificate {
  std::vector<std::string> textures;  ///< what it was made from, by name ...
  std::vector<double> speeds_mps;     ///< ... and mean speed
  double speed_ratio = 0;             ///< fastest over slowest
  double confidence_needed = 0;       ///< for a verdict
  std::string created, creator;
  std::vector<CertifiedPeak> peaks;  ///< by growing spatial frequency
};

/// "spatial", "temporal", "undecided", as in the JSON.
std::string verdict_name(PeakVerdict verdict);

}  // namespace tacto::schema
