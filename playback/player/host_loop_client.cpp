// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/host_loop_client.hpp"

#include <fmt/format.h>

namespace tacto::playback {
namespace {

std::string words_of(const EdgeToDrive& latency) {
  return fmt::format(
      "from the encoder's edge to the drive: p50 {:.2f} ms, p99 {:.2f} ms (count's age, queue, round trip)",
      1e3 * latency.p50_s, 1e3 * latency.p99_s);
}

}  // namespace

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
  options.loop = "host";
  options.lateness_ns = [&board = here.loop->board()](std::uint64_t tick) { return board.lateness_ns(tick); };
  options.due_ns = [&board = here.loop->board()](std::uint64_t tick) { return board.due_ns(tick); };
  options.measured = [&board = here.loop->board()](std::uint64_t tick, SampleRun& into) {
    board.take_samples(tick, into);
  };
  options.latency = [&loop = *here.loop] { return words_of(loop.latency()); };
  return here;
}

}  // namespace tacto::playback
