// SPDX-License-Identifier: GPL-3.0-or-later
// One playback without a daemon, from opening the device to the closed session.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "playback/host-loop/host_loop.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/model/limit_tally.hpp"
#include "playback/player/player.hpp"
#include "playback/player/program.hpp"

namespace tacto::playback {

struct PlayOptions {
  ProgramRequest program;
  std::string device_uri;
  std::string transducer;                 ///< empty: the device's own
  std::optional<FingerPath> finger_path;  ///< of an emulated device; none: its own finger
  std::optional<double> time_s;           ///< default: as long as the finger's path, or 10 s
  double gain = 1;
  bool loop_here = false;  ///< closed by this computer, on a device that keeps time
  /// Of a data acquisition card: plays without the watchdog of its wiring. The session keeps this.
  bool without_watchdog = false;
  PrepareOptions prepare;  ///< rate, inverse, delay ...; gain, ends, encoder and limits are set later
  std::string session;     ///< its file
  /// On a device that keeps time, play begins at this time, or as soon as the texture is on the device. An
  /// emulated finger begins its path with it.
  std::optional<std::chrono::steady_clock::time_point> begins_at = std::nullopt;
  bool path_repeated = false;  ///< an emulated finger repeats its path to the end (FingerScript::repeated)
  /// Called between the messages of ticks, with the seconds since the beginning; it may change the gain and
  /// set marks. False ends the playback, by a ramp.
  std::function<schema::Result<bool>(Player& player, double played_s)> steer = {};
  /// Called like `steer`, also while `begins_at` is awaited, when `played_s` is below 0; it may add notes.
  std::function<void(Player& player, double played_s)> watch = {};
  bool follow_force = false;  ///< PlayerOptions::follow_force
};

/// Figures of a loop on this computer.
struct HostLoopFigures {
  EdgeToDrive latency;
  double looked_ahead_s = 0;  ///< the part that the look-ahead compensates
  std::uint64_t missed_ticks = 0;
};

struct PlayOutcome {
  PlayerStatus status;  ///< its ticks are all to the end, the rest is from before the stop
  RecorderCounts recorder;
  std::string device, simulated;
  bool real_time = true;                ///< whether the device keeps time
  std::optional<std::string> off_note;  ///< if the finger was off the textures for over a tenth of the time
  double asked_s = 0;
  double late_s = 0;                   ///< of the beginning, after PlayOptions::begins_at
  std::optional<double> rests_from_s;  ///< end of the path, if the playback is longer: the finger rests
  double passes_to_hz = 0, delay_s = 0, delay_left_s = 0, inverse_error_db = 0;
  double loop_period_m = 0, loop_seam_m = 0;  ///< of a looped texture
  std::vector<std::string> notes;
  std::optional<TickDecision> decision;           ///< of the program's budget
  schema::PlaybackChoices choices;                ///< the choices used
  double gain_m_per_n = 0;                        ///< the largest of the textures' gains
  double default_gain_m_per_n = 0;                ///< the same without the gain of the request
  std::optional<schema::PlaybackGain> kept_gain;  ///< the gain stored with the texture, if that was used
  std::optional<LimitTally> limits;               ///< of the session; none: unknown, `notes` say why
  std::optional<HostLoopFigures> looped;
  std::vector<HeldLayer> held;               ///< of forces with hold_stable
  std::vector<std::string> not_judged = {};  ///< layers of forces whose stiffness is not computed
};

/// Emulated devices play as fast as possible, or paced; `stop_asked` ends the playback early, by a ramp. A
/// fault ends it too, and is in the outcome. Errors: usage, if this computer is to close the loop of a device
/// that does not keep time; as open_player_device, close_loop_on_host, make_program, Player.
schema::Result<PlayOutcome> play_once(const PlayOptions& options, const std::function<bool()>& stop_asked,
                                      const std::function<void(double)>& progress = {});

/// Whether `play` has to play forces: on an emulated force device, or if the file is a scene with patches.
bool plays_forces(const std::string& what, const std::string& device_uri);

struct ForcePlayOptions {
  ForceRequest program;
  std::string device_uri, session;
  std::string path;              ///< of the hand or device (open_force_device)
  std::string script;            ///< file of commands (read_scene_script); empty: none
  std::optional<double> time_s;  ///< default: as long as the path, or 10 s
};

/// The same for the force patches of a scene. Errors: as open_force_device, make_force_program,
/// read_scene_script, Player; malformed, for a command of the script after the end.
schema::Result<PlayOutcome> play_forces_once(const ForcePlayOptions& options,
                                             const std::function<bool()>& stop_asked,
                                             const std::function<void(double)>& progress = {});

}  // namespace tacto::playback
