// SPDX-License-Identifier: GPL-3.0-or-later
// The loop closed on this computer, as the daemon and `play` both ask for it.
#pragma once

#include "playback/host-loop/host_loop.hpp"
#include "playback/player/player.hpp"

namespace tacto::playback {

/// Empty where the device closes the loop itself.
struct LoopHere {
  std::unique_ptr<HostLoop> loop;
  std::unique_ptr<firmware_host::Client> client;  ///< the player's, to this computer's own core

  explicit operator bool() const { return loop != nullptr; }
};

/// Begins the loop between a device and a player, and gives the player's options what the loop knows of its
/// ticks. `device` is the loop's as long as it lives. Errors: as HostLoop::begin, Client::connect.
schema::Result<LoopHere> close_loop_here(firmware_host::Client& device, const std::string& uri,
                                         const HostLoopOptions& loop_options, PlayerOptions& options);

}  // namespace tacto::playback
