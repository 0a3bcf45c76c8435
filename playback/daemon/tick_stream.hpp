// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the ticks of a playback as events for the clients that watch them (CONTROL.md, "Ticks").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "data-schema/control/control.hpp"
#include "data-schema/session/session.hpp"

namespace tacto::playback {

/// For the thread that receives the ticks from the device or from the loop, never for the loop's thread.
class TickStream {
 public:
  /// While no client asks for ticks, none are kept.
  void turn(bool on);
  void take(const schema::SessionTick& tick);
  /// The members of the events for the ticks so far, which are then forgotten. A cell of 0.5 ms whose end is
  /// missing waits for the next call, unless these are the last ticks.
  std::vector<schema::ControlFields> take_events(double rate_hz, bool last);

 private:
  bool on_ = false;
  std::vector<schema::SessionTick> ticks_;
};

}  // namespace tacto::playback
