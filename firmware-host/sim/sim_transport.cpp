// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/sim_transport.hpp"

#include <algorithm>

namespace tacto::firmware_host {

SimTransport::SimTransport(SimBoard& board, bool paced) : board_(board) {
  if (paced) pacer_.emplace();
}

// Where nothing ticks, nothing will come: the rest of the time is over at once.
void SimTransport::pass_time(double until_s) {
  while (board_.to_host().empty() && now_s_ < until_s && board_.ticking()) {
    now_s_ += board_.host_period_s();
    board_.step();
    board_.poll();
  }
  if (board_.to_host().empty()) now_s_ = std::max(now_s_, until_s);
  if (pacer_) pacer_->wait_until(now_s_);
}

schema::Result<std::size_t> SimTransport::read(std::span<std::uint8_t> bytes, double timeout_s) {
  board_.poll();
  pass_time(now_s_ + timeout_s);
  std::vector<std::uint8_t>& waiting = board_.to_host();
  const std::size_t size = std::min(bytes.size(), waiting.size());
  std::copy_n(waiting.begin(), size, bytes.begin());
  waiting.erase(waiting.begin(), waiting.begin() + size);
  return size;
}

schema::Result<void> SimTransport::write(std::span<const std::uint8_t> bytes, double) {
  board_.from_host().insert(board_.from_host().end(), bytes.begin(), bytes.end());
  board_.poll();
  return {};
}

}  // namespace tacto::firmware_host
