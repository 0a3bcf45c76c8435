// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of zeros at either end of a WAV: file systems return zeros for pages that they lost. Internal to
// this folder.
#pragma once

#include <cstdint>
#include <string>

#include "data-schema/wav/riff_layout.hpp"

namespace tacto::schema {

/// The number of frames from the first on with zeros in all their bytes. Only whole frames count; 0 for a
/// file that cannot be read.
std::uint64_t zero_frames_at_start(const std::string& path, const RiffLayout& layout);
/// The same up to the last whole frame.
std::uint64_t zero_frames_at_end(const std::string& path, const RiffLayout& layout);

}  // namespace tacto::schema
