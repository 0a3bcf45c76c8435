// SPDX-License-Identifier: GPL-3.0-or-later
// What the sanitizers' run leaves to the plain one: numbers of draws that only statistics need.
#pragma once

#include <cstdlib>

namespace tacto {

/// Whether this build runs under sanitizers: its environment says so (tests/CMakeLists.txt).
inline bool sanitized() {
  return std::getenv("TACTO_SANITIZED") != nullptr;
}

/// How often to draw: `all`, but under sanitizers `few`, which take the same paths through the code.
/// Shares of so few are not to be judged.
inline int draws(int all, int few) {
  return sanitized() ? few : all;
}

}  // namespace tacto
