// SPDX-License-Identifier: GPL-3.0-or-later
// Plays once, from opening the device to the closed session, without a daemon.
#pragma once

#include <functional>

#include "playback/host-loop/host_loop.hpp"
#include "playback/model/limit_tally.hpp"
#include "playback/player/player.hpp"
#include "playback/player/program.hpp"

namespace tacto::playback {

struct PlayOptions {
  ProgramRequest program;
  std::string device_uri;
  std::string transducer;        ///< empty: the device's own
  std::string finger_path;       ///< CSV, for an emulated device; empty: its own finger
  std::optional<double> time_s;  ///< unless told as long as the finger's path, or 10 s
  double gain = 1;
  bool loop_here = false;  ///< closed by this computer, on a device that keeps time
  PrepareOptions prepare;  ///< rate, inverse, delay ...; gain, ends, encoder and limits are filled in
  std::string session;     ///< its file
};

/// Of a loop that this computer closed.
struct LoopedHere {
  EdgeToDrive latency;
  double looked_ahead_s = 0;  ///< of it, by what was played
  std::uint64_t missed_ticks = 0;
};

struct PlayOutcome {
  PlayerStatus status;  ///< as it was before the device was disarmed
  RecorderCounts recorder;
  std::string device, simulated;
  double asked_s = 0;
  double passes_to_hz = 0, delay_s = 0, delay_left_s = 0, inverse_error_db = 0;
  double loop_period_m = 0, loop_seam_m = 0;  ///< of a looped texture
  std::vector<std::string> notes;
  std::optional<TickDecision> decision;           ///< of the program's budget
  schema::PlaybackChoices choices;                ///< with which it was played
  double gain_m_per_n = 0;                        ///< the largest of its textures
  std::optional<schema::PlaybackGain> kept_gain;  ///< the texture's own, where it was played with that
  std::optional<LimitTally> limits;               ///< of the session; none: not known, `notes` say why
  std::optional<LoopedHere> looped;
};

/// Emulated devices play as fast as they can, or paced; `stop_asked` ends it early, by a ramp. A fault ends
/// it too, and is in the outcome. Errors: usage, for a loop that
/// this computer is to close on a device that keeps no time; as open_player_device, close_loop_here,
/// make_program, Player.
schema::Result<PlayOutcome> play_once(const PlayOptions& options, const std::function<bool()>& stop_asked,
                                      const std::function<void(double)>& progress = {});

}  // namespace tacto::playback
