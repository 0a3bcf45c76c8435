// SPDX-License-Identifier: GPL-3.0-or-later
// Whether those who have to stay while something is armed are still there (CONTROL.md, "Who has to stay").
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data-schema/control/control.hpp"

namespace tacto::playback {

/// What one client, or all of them, were heard to say.
struct LinesHeard {
  bool connected = true;    ///< the client; of all of them always true
  std::uint64_t lines = 0;  ///< that came until now, whatever they say
};

/// What holds while something is armed.
struct StayRules {
  std::optional<std::uint64_t> client;  ///< `while_connected`: who armed; none: nobody has to stay connected
  std::optional<double> dead_man_s;     ///< longest time without a line: of `client`, else of any client
};

/// What `arm` asks for, with the time that the configuration has: the shorter one holds.
StayRules stay_rules(const schema::ControlRequest& arm, std::optional<double> configured_s);

/// Silence is counted in steps of at most 0.1 s, a loop's longest: while the daemon itself waits for a device
/// or is stopped, lines wait unread, and that is not the client's silence. One thread.
class StayWatch {
 public:
  void begin(const StayRules& rules);
  void end() { *this = {}; }
  const StayRules& rules() const { return rules_; }
  /// Call after the lines that came were taken in; `passed_s` since the last call. Why the drive has to fall,
  /// where it has to.
  std::optional<std::string> why_to_fall(const LinesHeard& heard, double passed_s);

 private:
  StayRules rules_;
  std::uint64_t lines_ = 0;
  double silent_s_ = 0;
};

}  // namespace tacto::playback
