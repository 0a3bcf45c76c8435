// SPDX-License-Identifier: GPL-3.0-or-later
// The length of a WAV in its header and in the file: libsndfile silently reads what is there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tacto::schema {

struct RiffLength {
  std::uint64_t promised_frames = 0;
  std::uint64_t present_frames = 0;
};

/// Of a RIFF or RF64 file. None for other formats, for a header that is itself cut off, and where the writer
/// left the length open because it wrote to a pipe.
std::optional<RiffLength> riff_length(const std::string& path);

}  // namespace tacto::schema
