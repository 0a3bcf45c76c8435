// SPDX-License-Identifier: GPL-3.0-or-later
// One pass over a texture on the emulated device, at one speed, through the whole way of playback.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/player/play.hpp"
#include "playback/session/session_columns.hpp"

namespace tacto::analysis {

struct EmulatedPass {
  playback::SessionColumns columns;  ///< the drive as it was sent, tick by tick
  playback::PlayOutcome outcome;
  /// Where the finger was at each tick, exactly: the encoder knows it to a count.
  std::vector<double> position_m;
};

/// Texture, upload over the wire, the firmware's kernel on the emulated encoder's counts, session: as
/// `tactograph play`. The finger goes at `speed_mps` from 0.25 s before the texture to 0.25 s behind it.
/// `progress` hears which part of it was played. `options` names program, device and preparation; path, time
/// and session are filled in. Errors: as play_once; usage: stopped; internal: the session's counts are not
/// the path's.
schema::Result<EmulatedPass> emulated_pass(const schema::Texture& texture, playback::PlayOptions options,
                                           double speed_mps, const std::function<bool()>& stop_asked,
                                           const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
