// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the force patches of a scene on a force device, once, and keeps every tick in a session.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/playback_defaults.hpp"
#include "playback/player/flight_recorder.hpp"

namespace tacto::playback {

struct ScenePlayOptions {
  std::string scene, device_uri, session;
  /// Of an emulated device: the place to which the person moves the hand, or the path of the device without a
  /// hand (read_axis_paths()); empty: all axes at 0.
  std::string path;
  std::optional<double> time_s, rate_hz;  ///< default: the path's duration or 10 s; the device's largest rate
  double onset_s = schema::kOnsetS;
};

struct ScenePlayOutcome {
  std::string device, simulated;
  double rate_hz = 0;
  RecorderCounts recorder;
  std::uint64_t link_lost = 0, peak_limited = 0, slew_limited = 0, rms_limited = 0;  ///< ticks
  double force_peak_n = 0;                                                           ///< of the vector
  std::string fault;  ///< with what to do; empty if there is none
  std::vector<std::string> notes;
};

/// Whether `play` has to play forces: on an emulated force device, or if the file is a scene with patches.
bool plays_forces(const std::string& what, const std::string& device_uri);

/// Errors: as read_scene, prepare_scene, force_setup_of, open_player_device, read_axis_paths, check_travel,
/// FlightRecorder; unsuitable: a device without forces, a path for a device that is not emulated; device.
schema::Result<ScenePlayOutcome> play_scene(const ScenePlayOptions& options,
                                            const std::function<bool()>& stop_asked,
                                            const std::function<void(double)>& progress);

}  // namespace tacto::playback
