// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/host_loop_client.hpp"

namespace tacto::playback {

schema::Result<HostLoopClient> close_loop_on_host(firmware_host::Client& device, const std::string& uri,
                                                  const HostLoopOptions& loop_options,
                                                  PlayerOptions& options) {
  HostLoopClient here;
  auto loop = HostLoop::begin(device, loop_options);
  TACTO_TRY(loop);
  here.loop = std::move(*loop);
  auto connected = firmware_host::Client::connect(here.loop->transport(), uri);
  TACTO_TRY(connected);
  here.client = std::move(*connected);
  options.loop = here.loop.get();
  return here;
}

}  // namespace tacto::playback
