// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of nothing but zeros at either end of a WAV: what a file system gives for pages that it lost.
// Internal to this folder.
#pragma once

#include <cstdint>
#include <string>

#include "data-schema/wav/riff_layout.hpp"

namespace tacto::schema {

/// How many frames from the first on are zero in all their bytes. Only whole frames count; a file that can't
/// be read has none.
std::uint64_t zero_frames_at_start(const std::string& path, const RiffLayout& layout);
/// The same up to the last whole frame.
std::uint64_t zero_frames_at_end(const std::string& path, const RiffLayout& layout);

}  // namespace tacto::schema
