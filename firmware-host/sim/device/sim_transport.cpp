// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_transport.hpp"

#include <algorithm>

#include "firmware-host/link/hosted_board.hpp"

namespace tacto::firmware_host {
namespace {

constexpr double kLongestNapS = 10e-3;  // half of the block that capture writes at once

}  // namespace

SimTransport::SimTransport(EmulatedBoard& board, bool paced, std::optional<double> link_buffer_s)
    : board_(board), link_buffer_s_(link_buffer_s) {
  if (paced) pacer_.emplace();
}

void SimTransport::tick() {
  now_s_ += board_.host_period_s();
  board_.step();
  board_.poll();
}

// Without ticks no bytes can arrive, so that the rest of the time passes at once.
void SimTransport::pass_time(double until_s) {
  while (board_.to_host().empty() && now_s_ < until_s && board_.ticking()) tick();
  if (board_.to_host().empty()) now_s_ = std::max(now_s_, until_s);
  if (pacer_) pacer_->wait_until(now_s_);
}

// Computes all ticks that are due, also if nothing is read; then sleeps while the link fills a little.
void SimTransport::pass_real_time(double until_s) {
  const double nap_s = std::min(kLongestNapS, *link_buffer_s_ / 4);
  board_.set_link_bytes(static_cast<std::size_t>(*link_buffer_s_ * board_.stream_bytes_per_s()));
  for (;;) {
    for (double due_s = pacer_->now_s(); now_s_ + board_.host_period_s() <= due_s;) tick();
    if (!board_.to_host().empty() || now_s_ >= until_s) return;
    pacer_->sleep_until(now_s_ + std::max(nap_s, board_.host_period_s()));
  }
}

schema::Result<std::size_t> SimTransport::read(std::span<std::uint8_t> bytes, double timeout_s) {
  board_.poll();
  if (link_buffer_s_ && board_.ticking())
    pass_real_time(now_s_ + timeout_s);
  else
    pass_time(now_s_ + timeout_s);
  return take_first(board_.to_host(), bytes);
}

// A device that was at rest does not catch up when a command arrives.
schema::Result<void> SimTransport::write(std::span<const std::uint8_t> bytes, double) {
  if (pacer_ && !board_.ticking()) now_s_ = std::max(now_s_, pacer_->now_s());
  board_.from_host().insert(board_.from_host().end(), bytes.begin(), bytes.end());
  board_.poll();
  return {};
}

}  // namespace tacto::firmware_host
