// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of frames on their way from the thread that captures to the thread that writes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <semaphore>
#include <vector>

#include "firmware-host/link/device.hpp"

namespace tacto::capture {

struct FrameBlock {
  std::vector<std::int32_t> codes;  ///< room for a block
  std::size_t used = 0;             ///< codes in it
  firmware_host::StreamEvents events;
  std::vector<schema::Mark> marks;
  bool last = false;  ///< nothing comes after it
};

/// A ring of blocks that are allocated once: one thread fills, one takes. A slow disk makes the filling
/// thread wait when all are full, and the device then says what it lost.
class BlockQueue {
 public:
  BlockQueue(std::size_t blocks, std::size_t codes) : free_(static_cast<std::ptrdiff_t>(blocks)), filled_(0) {
    ring_.resize(blocks);
    for (FrameBlock& block : ring_) block.codes.resize(codes);
  }

  /// The next block to fill, waited for; then filled().
  FrameBlock& to_fill() {
    free_.acquire();
    FrameBlock& block = ring_[next_to_fill_++ % ring_.size()];
    block.used = 0;
    block.events = {};
    block.marks.clear();
    return block;
  }
  void filled() { filled_.release(); }

  /// The next block to take, waited for; then taken().
  FrameBlock& to_take() {
    filled_.acquire();
    return ring_[next_to_take_++ % ring_.size()];
  }
  void taken() { free_.release(); }

 private:
  std::vector<FrameBlock> ring_;
  std::size_t next_to_fill_ = 0, next_to_take_ = 0;  // each of one thread alone
  std::counting_semaphore<> free_, filled_;
};

}  // namespace tacto::capture
