// SPDX-License-Identifier: GPL-3.0-or-later
// What a loop on this computer measures of its ticks, for the player.
#pragma once

#include <cstdint>
#include <string>

#include "playback/host-loop/tray_samples.hpp"

namespace tacto::playback {

/// Of one of the last 16,384 ticks since arming. A device that closes the loop itself has none.
class LoopView {
 public:
  virtual ~LoopView() = default;
  virtual std::int32_t lateness_ns(std::uint64_t tick) const = 0;
  /// When a tick was due, by the device's clock; more precise than the time in its message.
  virtual std::int64_t due_ns(std::uint64_t tick) const = 0;
  /// Appends the samples of the tray's sensor up to a tick.
  virtual void take_samples(std::uint64_t tick, SampleRun& into) = 0;
  /// From the encoder's edge to the drive, in words, for the session.
  virtual std::string latency_words() const = 0;
};

}  // namespace tacto::playback
