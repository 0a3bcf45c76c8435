// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs the WAV of an interrupted recording. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// The content of such a WAV.
struct WavRemains {
  std::uint64_t frames = 0;
  std::vector<std::string> notes;  ///< what was repaired, what was cut off, what may be lost
};

/// Writes the header again if a power cut left zeros in it, by the format of `header`. Cuts off an incomplete
/// frame, and frames of zeros beyond the length in the WAV's header: reserved space without samples.
/// `known_frames`: frames that the journal records. Changes nothing in a file that it cannot read. Errors:
/// not_found, without a WAV; malformed, if its first bytes are neither its header nor zeros, or if it is
/// empty although the journal records more than what may have been on its way; cannot_write.
Result<WavRemains> salvage_wav(const std::string& wav, const RecordingHeader& header,
                               std::uint64_t known_frames);

}  // namespace tacto::schema
