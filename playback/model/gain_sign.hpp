// SPDX-License-Identifier: GPL-3.0-or-later
// The effect of a gain's sign.
#pragma once

#include <cmath>

namespace tacto::playback {

/// A gain below 0 moves the tray against the texture's force: ridges become grooves.
inline bool inverts_texture(double gain) {
  return std::signbit(gain) && gain != 0;
}

/// Adds `inverts_texture` to a report or an answer of the daemon if the gain is below 0. `add` takes a key
/// and a value.
template <class Add>
void tell_inversion(double gain, const Add& add) {
  if (inverts_texture(gain)) add("inverts_texture", true);
}

}  // namespace tacto::playback
