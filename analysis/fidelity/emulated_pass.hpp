// SPDX-License-Identifier: GPL-3.0-or-later
// One pass over a texture on the emulated device, at one speed, through the complete chain of playback.
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
  /// Exact position of the finger at each tick; the encoder's resolution is one count.
  std::vector<double> position_m;
};

/// Plays as `tactograph play` does: texture, upload over the wire, the firmware's kernel with the counts of
/// the emulated encoder, session. The finger moves at `speed_mps` from 0.25 s before the texture to 0.25 s
/// behind it. `progress` receives the played fraction. `options` contains program, device and preparation;
/// path, time and session are set here. Errors: those of play_once; usage: stopped; internal: the session's
/// counts do not match the path.
schema::Result<EmulatedPass> emulated_pass(const schema::Texture& texture, playback::PlayOptions options,
                                           double speed_mps, const std::function<bool()>& stop_asked,
                                           const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
