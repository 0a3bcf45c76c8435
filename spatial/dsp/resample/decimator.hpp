// SPDX-License-Identifier: GPL-3.0-or-later
// Low-passes a block, keeps every `grid`-th sample, and distributes these to the phases that frames read.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "spatial/dsp/resample/decimation.hpp"

namespace tacto::spatial {

/// A term of sum_t weight_t source_t[i], in single precision. Every source has as many values as the output.
struct Tap {
  const float* source = nullptr;
  float weight = 0;
};
void weighted_sum(std::span<const Tap> taps, std::span<float> out);

/// Buffers and filters for blocks up to a size; no allocation in run(). Not shared between threads.
class Decimator {
 public:
  /// Precondition: decimation.factor > 1. Throws bad_alloc.
  Decimator(const Decimation& decimation, std::size_t longest_block);

  /// Number of samples needed before the block; after it the same number and `grid` more are needed.
  std::size_t reach() const { return grid_ * fine_reach_ + coarse_reach_; }
  /// `samples`: reach() before the block, its `length`, reach() + grid after it.
  void run(std::span<const float> samples, std::size_t length);
  /// Every factor-th sample of the filtered block from `offset` on, a multiple of `grid`. Valid until the
  /// next run().
  const float* from(std::size_t offset) const;

 private:
  void to_grid(std::span<const float> samples, std::size_t count);
  void to_phases(std::span<const float> values);

  std::size_t grid_, phases_;
  std::size_t coarse_reach_ = 0,
              fine_reach_ = 0;             // of the filters to `grid` (in samples) and to `factor` (in grids)
  std::vector<float> coarse_, fine_;       // their values
  std::vector<std::vector<float>> split_;  // the block's samples, every grid-th from each of `grid` starts
  std::vector<float> gridded_, smooth_;
  std::vector<std::vector<float>> phase_;
  std::vector<Tap> taps_;
};

}  // namespace tacto::spatial
