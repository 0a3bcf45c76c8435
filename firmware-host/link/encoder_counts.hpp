// SPDX-License-Identifier: GPL-3.0-or-later
// Differences of encoder counts as in the device, for folders that do not include its core.
#pragma once

#include <cstdint>

#include "firmware-host/core/kernel/counts_between.hpp"

namespace tacto::firmware_host {

/// The shorter way between two counts: a 32-bit counter that overflows at 2^31 continues.
inline std::int32_t counts_between(std::int32_t from, std::int32_t to) noexcept {
  return core::counts_between(from, to);
}

}  // namespace tacto::firmware_host
