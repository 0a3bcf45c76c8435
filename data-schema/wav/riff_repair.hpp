// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs a WAV's header in place.
#pragma once

#include <cstdint>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// Writes another rate into the header. Errors: malformed, if it is not a WAV; cannot_write.
Result<void> set_riff_rate(const std::string& path, std::uint32_t sample_rate_hz);

/// Makes the header agree with the file, after a writer that did not close it: cuts off an unfinished frame,
/// sets the sizes, and makes plain RIFF of an RF64 under 4 GB. Returns the number of frames. Errors:
/// malformed, if the header was not finished; cannot_write.
Result<std::uint64_t> repair_riff(const std::string& path);

}  // namespace tacto::schema
