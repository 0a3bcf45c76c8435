// SPDX-License-Identifier: GPL-3.0-or-later
// What a session's finger was to receive.
#pragma once

#include <string>
#include <vector>

#include "playback/daemon/session_columns.hpp"

namespace tacto::playback {

struct SessionWanted {
  std::vector<double> displacement_m;  ///< one a row, in the session's band
  std::vector<bool> unknown;           ///< a row: a texture that is not known had a part in what was felt
  std::vector<std::string> notes;      ///< of textures that are not known, and why
};

/// Gain x textures along the path between the recorded counts (monotone cubics through the places where the
/// count changed), read exactly (reference/wanted.hpp). Gain and changes of texture are those that the kernel
/// follows and fades (texture_mix.hpp), felt when the drive that looked ahead is: look_ahead_ticks later.
/// Precondition: rows of one rate (evened()).
SessionWanted wanted_in(const SessionColumns& columns);

}  // namespace tacto::playback
