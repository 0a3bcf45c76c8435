// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/board_link.hpp"

#include <algorithm>

namespace tacto::firmware_host {

void BurstQueue::put(std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  came_.notify_one();
}

Burst BurstQueue::take(std::size_t most, std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, wait, [&] { return !bytes_.empty(); });
  Burst burst;
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(most, bytes_.size()));
  burst.bytes.assign(bytes_.begin(), end);
  bytes_.erase(bytes_.begin(), end);
  burst.last = bytes_.empty();
  return burst;
}

void BurstQueue::clear() {
  const std::lock_guard lock(mutex_);
  bytes_.clear();
}

std::size_t BurstQueue::waiting() const {
  const std::lock_guard lock(mutex_);
  return bytes_.size();
}

}  // namespace tacto::firmware_host
