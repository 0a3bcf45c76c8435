// SPDX-License-Identifier: GPL-3.0-or-later
// Closes the loop on this computer, for the daemon and `play`.
#pragma once

#include "playback/host-loop/host_loop.hpp"
#include "playback/player/player.hpp"

namespace tacto::playback {

/// Empty if the device closes the loop itself.
struct HostLoopClient {
  std::unique_ptr<HostLoop> loop;
  std::unique_ptr<firmware_host::Client> client;  ///< the player's, connected to the core on this computer

  explicit operator bool() const { return loop != nullptr; }
};

/// Starts the loop between a device and a player, and sets the player's option `loop`. The loop uses `device`
/// as long as it exists. Errors: as HostLoop::begin, Client::connect.
schema::Result<HostLoopClient> close_loop_on_host(firmware_host::Client& device, const std::string& uri,
                                                  const HostLoopOptions& loop_options,
                                                  PlayerOptions& options);

}  // namespace tacto::playback
