// SPDX-License-Identifier: GPL-3.0-or-later
// What every door to FFTW needs: aligned buffers, and the lock around its planner. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>

namespace tacto::spatial {

/// FFTW's planners (of all precisions) keep global tables; only execution may run beside itself.
std::mutex& planner_mutex();

struct FreeBuffer {
  void operator()(void* memory) const { std::free(memory); }
};
template <class T>
using AlignedBuffer = std::unique_ptr<T[], FreeBuffer>;

/// Room for `count` elements, not initialised, aligned to a cache line: enough for any SIMD unit FFTW uses.
/// Throws bad_alloc.
template <class T>
AlignedBuffer<T> aligned_buffer(std::size_t count) {
  constexpr std::size_t kAlignment = 64;
  const std::size_t bytes = (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
  void* memory = std::aligned_alloc(kAlignment, bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return AlignedBuffer<T>(static_cast<T*>(memory));
}

}  // namespace tacto::spatial
