// SPDX-License-Identifier: GPL-3.0-or-later
// tactographd's configuration, one JSON file: schemas/daemon.schema.json describes each member.
#pragma once

#include <optional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/base/playback_defaults.hpp"
#include "data-schema/results/budget.hpp"
#include "data-schema/scene/playback_choices.hpp"

namespace tacto::schema {

struct DaemonConfig {
  std::string device, transducer;
  std::string loop = "device";
  double rate_hz = 2000;  ///< the paper's
  std::string socket, socket_group;
  std::optional<int> tcp_port;  ///< of 127.0.0.1; 0: a free one
  std::string tcp_token_file;
  int most_clients = 16;
  std::string sessions, files;
  int real_time_priority = 50;
  int watchdog_ms = 100;
  double most_speed_mps = 2;
  std::optional<double> dead_man_s;  ///< longest silence of the clients while armed
  double onset_s = kOnsetS;
  double most_late_percent = 20;
  std::string finger_path;
  bool undo_hysteresis = true;
  Budget budget;  ///< of what is loaded
  std::optional<double> max_tick_ns;
  PlaybackChoices playback;  ///< if neither a request nor a scene sets them
};

/// Errors: not_found; malformed, by JSON pointer, also for a member that does not exist; unsupported_version.
Result<DaemonConfig> read_daemon_config(const std::string& path);

}  // namespace tacto::schema
