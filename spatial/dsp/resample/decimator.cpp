// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/decimator.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "spatial/dsp/fourier/simd_clones.hpp"
#include "spatial/dsp/resample/low_pass.hpp"

namespace tacto::spatial {
namespace {

// Numbers side by side (GCC's and Clang's vector extension): two registers of SSE2, or one of AVX2.
using Eight = float __attribute__((vector_size(32)));
constexpr std::size_t kEights = 4;  // at a time: their sums stay in registers
constexpr std::size_t kLane = 8 * kEights;

std::vector<float> single(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

TACTO_SIMD_INLINE void sum_lane(std::span<const Tap> taps, std::size_t at, float* out) {
  Eight sums[kEights] = {};
  for (const Tap& tap : taps) {
    const float* const source = tap.source + at;
    for (std::size_t i = 0; i < kEights; ++i) {
      Eight values;
      std::memcpy(&values, source + 8 * i, sizeof values);
      sums[i] += tap.weight * values;
    }
  }
  std::memcpy(out, sums, sizeof sums);
}

// Small weights first: terms that are added while the sum is small have small rounding errors (in total 9 dB
// less).
void order(std::vector<Tap>& taps) {
  std::ranges::sort(taps, {}, [](const Tap& tap) { return std::abs(tap.weight); });
}

// The usual case, in a form that compilers vectorise.
TACTO_SIMD_CLONES
void deinterleave_4(std::span<const float> values, std::vector<std::vector<float>>& hands) {
  const std::size_t rounds = values.size() / 4;
  const float* __restrict from = values.data();
  float* __restrict first = hands[0].data();
  float* __restrict second = hands[1].data();
  float* __restrict third = hands[2].data();
  float* __restrict fourth = hands[3].data();
  for (std::size_t i = 0; i < rounds; ++i) {
    first[i] = from[4 * i];
    second[i] = from[4 * i + 1];
    third[i] = from[4 * i + 2];
    fourth[i] = from[4 * i + 3];
  }
}

void deal(std::span<const float> values, std::vector<std::vector<float>>& hands) {
  const std::size_t players = hands.size(), rounds = values.size() / players;
  if (players == 4) return deinterleave_4(values, hands);
  for (std::size_t player = 0; player < players; ++player)
    for (std::size_t i = 0; i < rounds; ++i) hands[player][i] = values[i * players + player];
}

}  // namespace

TACTO_SIMD_CLONES
void weighted_sum(std::span<const Tap> taps, std::span<float> out) {
  std::size_t at = 0;
  for (; at + kLane <= out.size(); at += kLane) sum_lane(taps, at, out.data() + at);
  for (; at < out.size(); ++at) {
    out[at] = 0;
    for (const Tap& tap : taps) out[at] += tap.weight * tap.source[at];
  }
}

Decimator::Decimator(const Decimation& d, std::size_t longest_block)
    : grid_(d.grid), phases_(d.factor / d.grid) {
  assert(d.factor > 1 && d.factor % grid_ == 0);
  const auto grid = static_cast<double>(grid_);
  if (grid_ > 1) coarse_ = single(low_pass(d.pass, coarse_stop(d)));
  if (phases_ > 1) fine_ = single(low_pass(d.pass * grid, d.stop * grid));
  coarse_reach_ = coarse_.size() / 2;
  fine_reach_ = fine_.size() / 2;
  const std::size_t gridded = longest_block / grid_ + 1 + 2 * fine_reach_;
  split_.assign(grid_, std::vector<float>(gridded + coarse_.size() / grid_ + 1));
  gridded_.resize(gridded);
  smooth_.resize(gridded);
  phase_.assign(phases_, std::vector<float>(gridded / phases_ + 1));
}

// gridded[i] = sum_u coarse[u] samples[grid i + u]. With u = grid a + q, sample grid (i + a) + q is number i
// + a of the sequence that starts at q.
void Decimator::to_grid(std::span<const float> samples, std::size_t count) {
  deal(samples, split_);
  taps_.clear();
  for (std::size_t u = 0; u < coarse_.size(); ++u)
    taps_.push_back({split_[u % grid_].data() + u / grid_, coarse_[u]});
  order(taps_);
  weighted_sum(taps_, std::span(gridded_).first(count));
}

void Decimator::to_phases(std::span<const float> values) {
  deal(values, phase_);
  for (std::size_t rest = values.size() / phases_ * phases_; rest < values.size(); ++rest)
    phase_[rest % phases_][rest / phases_] = values[rest];
}

void Decimator::run(std::span<const float> samples, std::size_t length) {
  assert(samples.size() == length + 2 * reach() + grid_);
  const std::size_t points = length / grid_ + 1;
  std::span<const float> on_grid = samples;
  if (grid_ > 1) {
    to_grid(samples, points + 2 * fine_reach_);
    on_grid = std::span(gridded_).first(points + 2 * fine_reach_);
  }
  if (phases_ == 1) return to_phases(on_grid.first(points));
  taps_.clear();
  for (std::size_t u = 0; u < fine_.size(); ++u) taps_.push_back({on_grid.data() + u, fine_[u]});
  order(taps_);
  const auto smooth = std::span(smooth_).first(points);
  weighted_sum(taps_, smooth);
  to_phases(smooth);
}

const float* Decimator::from(std::size_t offset) const {
  assert(offset % grid_ == 0);
  const std::size_t point = offset / grid_;
  return phase_[point % phases_].data() + point / phases_;
}

}  // namespace tacto::spatial
