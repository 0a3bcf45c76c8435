// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether the clients that have to stay while the device is armed still do (CONTROL.md, "Who has to
// stay").
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data-schema/control/control.hpp"

namespace tacto::playback {

/// What was received from one client, or from all.
struct LinesReceived {
  bool connected = true;    ///< whether the client is connected; always true for all clients
  std::uint64_t lines = 0;  ///< received until now, whatever their content
};

/// The conditions while the device is armed.
struct StayRules {
  std::optional<std::uint64_t> client;  ///< with `while_connected`: the client that armed
  std::optional<double> dead_man_s;     ///< longest time without a line, of `client` or else of any client
};

/// The rules that `arm` requests; of its time and the configuration's the shorter one applies.
StayRules stay_rules(const schema::ControlRequest& arm, std::optional<double> configured_s);

/// Time without lines is counted in steps of at most 0.1 s, the longest step of the daemon's loop: while the
/// daemon waits for a device or is stopped, lines stay unread, and that time does not count as the client's
/// silence. For one thread.
class StayWatch {
 public:
  void begin(const StayRules& rules);
  void end() { *this = {}; }
  const StayRules& rules() const { return rules_; }
  /// Call after the received lines were read, with the time since the last call. Returns why the drive has to
  /// fall, if it does.
  std::optional<std::string> why_to_fall(const LinesReceived& heard, double passed_s);

 private:
  StayRules rules_;
  std::uint64_t lines_ = 0;
  double silent_s_ = 0;
};

}  // namespace tacto::playback
