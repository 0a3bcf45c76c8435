// SPDX-License-Identifier: GPL-3.0-or-later
// The layout of a WAV, and the contents of its header.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tacto::schema {

struct RiffLayout {
  bool wide = false;                ///< RF64: sizes of 64 bits in a chunk "ds64"
  std::uint64_t ds64_at = 0;        ///< of that chunk's content; 0 where there is none
  std::uint64_t format_at = 0;      ///< of the content of "fmt "; 0 where there is none
  std::uint64_t block_bytes = 0;    ///< of one frame
  std::uint64_t data_at = 0;        ///< of the first sample
  std::uint64_t data_bytes = 0;     ///< as "data" says
  std::uint64_t data_bytes_64 = 0;  ///< as "ds64" says
  std::uint64_t present_bytes = 0;  ///< from data_at to the end of the file
};

/// Of a RIFF or RF64 WAVE file, as far as its chunk "data". None for other formats, and if the header is cut
/// off before the samples.
std::optional<RiffLayout> riff_layout(const std::string& path);

}  // namespace tacto::schema
