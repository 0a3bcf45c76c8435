// SPDX-License-Identifier: GPL-3.0-or-later
// What boards have in common whose core runs in a process of this computer.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "firmware-host/core/firmware/board.hpp"

namespace tacto::firmware_host {

/// Room for a texture: 16 MB, of which the system gives only what is written to.
class HostedProfile {
 public:
  /// A metre of texture on a 1 um grid, in all its levels.
  static constexpr std::uint32_t kSamples = 1U << 22;
  float* data() { return samples_.get(); }

 private:
  std::unique_ptr<float[]> samples_ = std::make_unique_for_overwrite<float[]>(kSamples);
};

/// The core's view of what the board keeps, and goes on keeping.
inline core::Board board_of(const wire::Welcome& welcome, const std::vector<wire::Channel>& channels,
                            const std::vector<wire::Note>& notes, HostedProfile& profile) {
  core::Board board;
  board.about = welcome;
  board.channels = channels.data();
  board.channel_count = static_cast<std::uint8_t>(channels.size());
  board.notes = notes.data();
  board.note_count = static_cast<std::uint8_t>(notes.size());
  board.profile_memory = profile.data();
  board.profile_samples = HostedProfile::kSamples;
  return board;
}

/// Moves the first bytes that wait to `bytes`, as many as fit; gives their number.
inline std::size_t take_first(std::vector<std::uint8_t>& waiting, std::span<std::uint8_t> bytes) {
  const std::size_t size = std::min(bytes.size(), waiting.size());
  std::copy_n(waiting.begin(), size, bytes.begin());
  waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(size));
  return size;
}

}  // namespace tacto::firmware_host
