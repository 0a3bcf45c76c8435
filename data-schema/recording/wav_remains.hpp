// SPDX-License-Identifier: GPL-3.0-or-later
// The WAV of a recording that was broken off, made readable. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// What such a WAV holds.
struct WavRemains {
  std::uint64_t frames = 0;
  std::vector<std::string> notes;  ///< what was put right, what was cut off, what looks lost
};

/// Writes the header anew where a power cut left zeros in it, by the format of `header`, and cuts off a
/// broken frame, and frames of zeros that the WAV's header never promised: space that the file got, and no
/// samples. `known_frames` were there by the journal. Nothing is changed in a file that it can't read.
/// Errors: not_found, without a WAV; malformed, where its first bytes are neither its header nor zeros, and
/// where it holds nothing though the journal knows of more than what may have been on its way;
/// cannot_write.
Result<WavRemains> salvage_wav(const std::string& wav, const RecordingHeader& header,
                               std::uint64_t known_frames);

}  // namespace tacto::schema
