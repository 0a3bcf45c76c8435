// SPDX-License-Identifier: GPL-3.0-or-later
// Common parts of boards whose core runs in a process on this computer.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "firmware-host/core/firmware/board.hpp"
#include "firmware-host/core/firmware/hal.hpp"

namespace tacto::firmware_host {

/// Memory for a texture or a scene, allocated by the system only when it is written; default: 16 MB.
class HostedProfile {
 public:
  /// One metre of texture on a 1 um grid, with all levels.
  static constexpr std::uint32_t kSamples = 1U << 22;
  explicit HostedProfile(std::uint32_t samples = kSamples)
      : count_(samples), samples_(std::make_unique_for_overwrite<float[]>(samples)) {}
  float* data() { return samples_.get(); }
  std::uint32_t size() const { return count_; }

 private:
  std::uint32_t count_;
  std::unique_ptr<float[]> samples_;
};

/// The board's description for the core; the arguments must outlive it.
inline core::Board board_of(const wire::Welcome& welcome, const std::vector<wire::Channel>& channels,
                            const std::vector<wire::Note>& notes, HostedProfile& profile) {
  core::Board board;
  board.about = welcome;
  board.channels = channels.data();
  board.channel_count = static_cast<std::uint8_t>(channels.size());
  board.notes = notes.data();
  board.note_count = static_cast<std::uint8_t>(notes.size());
  board.profile_memory = profile.data();
  board.profile_samples = profile.size();
  return board;
}

/// Moves the first bytes of `waiting` to `bytes`, as many as fit; returns their number.
inline std::size_t take_first(std::vector<std::uint8_t>& waiting, std::span<std::uint8_t> bytes) {
  const std::size_t size = std::min(bytes.size(), waiting.size());
  std::copy_n(waiting.begin(), size, bytes.begin());
  waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(size));
  return size;
}

/// The link of a board whose bytes from and to the host wait in two of its members.
template <class Board, auto kFromHost, auto kToHost>
void use_queues(core::Hal& hal) {
  hal.receive = [](void* b, std::uint8_t* bytes, std::size_t size) noexcept {
    return take_first(static_cast<Board*>(b)->*kFromHost, {bytes, size});
  };
  hal.send = [](void* b, const std::uint8_t* bytes, std::size_t size) noexcept {
    auto& to_host = static_cast<Board*>(b)->*kToHost;
    to_host.insert(to_host.end(), bytes, bytes + size);
    return size;
  };
}

}  // namespace tacto::firmware_host
