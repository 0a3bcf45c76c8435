// SPDX-License-Identifier: GPL-3.0-or-later
// A WAV's header put right in place. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Writes another rate into the header. Errors: malformed, for what is no WAV; cannot_write.
Result<void> set_riff_rate(const std::string& path, std::uint32_t sample_rate_hz);

/// Makes the header say what the file holds, after a writer that never closed it: cuts off an unfinished
/// frame, sets the sizes, and makes plain RIFF of an RF64 under 4 GB. Gives the number of frames. Errors:
/// malformed, where not even the header was finished; cannot_write.
Result<std::uint64_t> repair_riff(const std::string& path);

}  // namespace tacto::schema
