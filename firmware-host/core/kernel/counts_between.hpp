// SPDX-License-Identifier: Apache-2.0
// Differences of encoder counts, also where the counter wraps.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// From one count to another, the short way: a counter that passes 2^31 goes on. Safe in the tick.
inline int32_t counts_between(int32_t from, int32_t to) noexcept {
  return static_cast<int32_t>(static_cast<uint32_t>(to) - static_cast<uint32_t>(from));
}

}  // namespace tacto::core
