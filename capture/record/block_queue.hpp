// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of frames between the capturing thread and the writing thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <semaphore>
#include <vector>

#include "firmware-host/link/device.hpp"

namespace tacto::capture {

struct FrameBlock {
  std::vector<std::int32_t> codes;  ///< the size of a block
  std::size_t used = 0;             ///< the codes that are valid
  firmware_host::StreamEvents events;
  std::vector<schema::Mark> marks;
  bool last = false;  ///< the last block of the recording
};

/// A ring of preallocated blocks with one producer and one consumer thread. With a slow disk all blocks fill
/// and the producer waits; the device then loses frames and reports them.
class BlockQueue {
 public:
  BlockQueue(std::size_t blocks, std::size_t codes) : free_(static_cast<std::ptrdiff_t>(blocks)), filled_(0) {
    ring_.resize(blocks);
    for (FrameBlock& block : ring_) block.codes.resize(codes);
  }

  /// Waits for the next free block; followed by filled().
  FrameBlock& to_fill() {
    free_.acquire();
    FrameBlock& block = ring_[next_to_fill_++ % ring_.size()];
    block.used = 0;
    block.events = {};
    block.marks.clear();
    return block;
  }
  void filled() { filled_.release(); }

  /// Waits for the next filled block; followed by taken().
  FrameBlock& to_take() {
    filled_.acquire();
    return ring_[next_to_take_++ % ring_.size()];
  }
  void taken() { free_.release(); }

 private:
  std::vector<FrameBlock> ring_;
  std::size_t next_to_fill_ = 0, next_to_take_ = 0;  // each is used by one thread only
  std::counting_semaphore<> free_, filled_;
};

}  // namespace tacto::capture
