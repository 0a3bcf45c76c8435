// SPDX-License-Identifier: GPL-3.0-or-later
// White noise for the participant's headphones: its samples, its level in words, the check of what was
// measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment/proof.hpp"

namespace tacto::analysis {

/// As Wiertlewski 2011 (white noise), in a band from the lowest frequency of playback to the third harmonic
/// of the highest one: a hysteresis produces odd harmonics. A level within 3 dB.
schema::MaskingNoise usual_masking_noise(double level_db);

inline constexpr double kNoiseRateHz = 48000, kNoisePeriodS = 30;
inline constexpr double kNoiseRmsDb =
    -20;  ///< re full scale; its peaks are 13 dB above, so nothing is clipped

/// One period, which repeats without a seam: each multiple of 1 / kNoisePeriodS in the band has the same
/// amplitude, and the phase 2 pi uniform_by_sum(SEED/noise/NUMBER). Full scale is 1. Precondition: low_hz
/// < high_hz <= 20 kHz.
std::vector<double> masking_noise(const schema::MaskingNoise& noise, const std::string& seed);

/// One channel, 32-bit float. Errors: usage, if the file exists and is to be kept; cannot_write.
schema::Result<void> write_masking_noise(const std::string& path, const schema::MaskingNoise& noise,
                                         const std::string& seed, schema::Existing existing);

/// For the journal: "64.5 dB", "not measured", or nothing if the protocol has no noise. Errors: usage: a
/// level without noise, or beyond the tolerance.
schema::Result<std::string> checked_masking_level(const schema::Protocol& protocol,
                                                  std::optional<double> measured_db);

/// "15 to 1500 Hz, 65 dB within 3 dB"; "none".
std::string noise_in_words(const std::optional<schema::MaskingNoise>& noise);
/// The same with the levels of a run, at its beginning and after each interruption.
std::string noise_of_run(const Run& run);

}  // namespace tacto::analysis
