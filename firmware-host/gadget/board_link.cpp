// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/board_link.hpp"

#include <algorithm>

namespace tacto::firmware_host {

void BurstQueue::put(std::span<const std::uint8_t> bytes, BurstEnd end) {
  const std::lock_guard lock(mutex_);
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  put_ += bytes.size();
  if (end != BurstEnd::none) ends_.push_back({put_, end});
  came_.notify_one();
}

Burst BurstQueue::take(std::size_t most, std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, wait, [&] { return something(); });
  Burst burst;
  std::size_t size = std::min(most, bytes_.size());
  if (!ends_.empty() && ends_.front().at - taken_ <= size) {
    size = ends_.front().at - taken_;
    burst.end = ends_.front().end;
    ends_.pop_front();
  }
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(size);
  burst.bytes.assign(bytes_.begin(), end);
  bytes_.erase(bytes_.begin(), end);
  taken_ += size;
  burst.last = !something();
  return burst;
}

void BurstQueue::clear() {
  const std::lock_guard lock(mutex_);
  bytes_.clear();
  ends_.clear();
  taken_ = put_;
}

std::size_t BurstQueue::waiting() const {
  const std::lock_guard lock(mutex_);
  return bytes_.size();
}

}  // namespace tacto::firmware_host
