// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of a record, and a function that reads values from any place of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>

#include "data-schema/base/error.hpp"

namespace tacto::spatial {

/// Frames [begin, end) of a record.
struct FrameRange {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
  bool contains(const FrameRange& other) const { return begin <= other.begin && other.end <= end; }
};

/// Reads out.size() values of a record from frame `first` on.
using ReadFrames = std::function<schema::Result<void>(std::size_t first, std::span<double> out)>;

/// Number of frames that are in memory at a time, unless a stroke is longer.
inline constexpr std::size_t kChunkFrames = 32768;

/// Calls work(part) for parts of `frames` of at most kChunkFrames, in order, until one fails.
template <class Work>
schema::Result<void> chunk_by_chunk(FrameRange frames, const Work& work) {
  for (std::size_t begin = frames.begin; begin < frames.end; begin += kChunkFrames)
    if (auto done = work(FrameRange{begin, std::min(begin + kChunkFrames, frames.end)}); !done) return done;
  return {};
}

}  // namespace tacto::spatial
