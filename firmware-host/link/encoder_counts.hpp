// SPDX-License-Identifier: GPL-3.0-or-later
// An encoder's counts as the device itself takes them, for folders that have nothing to do with its core.
#pragma once

#include <cstdint>

#include "firmware-host/core/kernel/counts_between.hpp"

namespace tacto::firmware_host {

/// From one count to another, the short way: a counter of 32 bits that passes 2^31 goes on.
inline std::int32_t counts_between(std::int32_t from, std::int32_t to) noexcept {
  return core::counts_between(from, to);
}

}  // namespace tacto::firmware_host
