// SPDX-License-Identifier: GPL-3.0-or-later
// What a gain's sign does.
#pragma once

#include <cmath>

namespace tacto::playback {

/// A gain below 0 moves the tray against the texture's force: what was a ridge is a groove.
inline bool inverts_texture(double gain) {
  return std::signbit(gain) && gain != 0;
}

/// Tells it in a verb's report or in an answer of the daemon; of any other gain nothing. `add` takes a key
/// and a value.
template <class Add>
void tell_inversion(double gain, const Add& add) {
  if (inverts_texture(gain)) add("inverts_texture", true);
}

}  // namespace tacto::playback
