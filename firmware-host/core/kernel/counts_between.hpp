// SPDX-License-Identifier: Apache-2.0
// Differences of encoder counts, including wrap-around.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// The shorter way between two counts: a counter that overflows at 2^31 continues. Safe in the tick.
inline int32_t counts_between(int32_t from, int32_t to) noexcept {
  return static_cast<int32_t>(static_cast<uint32_t>(to) - static_cast<uint32_t>(from));
}

}  // namespace tacto::core
