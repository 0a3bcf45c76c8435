// SPDX-License-Identifier: GPL-3.0-or-later
// The speed certificate of a texture: which of its peaks come from the surface, and which from vibration in
// time.
#pragma once

#include <string>
#include <vector>

namespace tacto::schema {

/// spatial: stays at one spatial frequency while the speed changes, so it comes from the surface. temporal:
/// stays at one frequency in Hz: a resonance, mains.
enum class PeakVerdict { spatial, temporal, undecided };

/// A peak in the texture that contains the certificate.
struct CertifiedPeak {
  PeakVerdict verdict = PeakVerdict::undecided;
  double confidence = 0;  ///< probability of the verdict; if undecided, of the more probable one
  /// The reason if it is undecided: "speed_ratio" (too small for the resolution), "signal_to_noise",
  /// "outside_band" (the place of the more probable hypothesis is in no other texture's valid band),
  /// "both_fit", "neither_fits"; else empty.
  std::string reason;
  double frequency_per_m = 0;     ///< in this texture
  double frequency_hz = 0;        ///< at this texture's mean speed
  double rms = 0;                 ///< of a sine of its power, where it was strongest; in the texture's unit
  double snr_db = 0;              ///< over the background, where it was strongest
  double snr_needed_db = 0;       ///< what noise alone reaches in one cell of 10,000
  double speed_ratio = 0;         ///< largest between two textures whose valid bands contain it
  double speed_ratio_needed = 0;  ///< at which the two hypotheses are one resolution apart
  std::vector<std::string> found_in;  ///< names of textures
};

struct Certificate {
  std::vector<std::string> textures;  ///< from which it was made, by name ...
  std::vector<double> speeds_mps;     ///< ... and mean speed
  double speed_ratio = 0;             ///< fastest over slowest
  double confidence_needed = 0;       ///< for a verdict
  std::string created, creator;
  std::vector<CertifiedPeak> peaks;  ///< by growing spatial frequency
};

/// "spatial", "temporal", "undecided", as in the JSON.
std::string verdict_name(PeakVerdict verdict);

}  // namespace tacto::schema
