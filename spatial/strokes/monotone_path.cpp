// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/monotone_path.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace tacto::spatial {
namespace {

constexpr double kLeastCreep = 1e-3;

// Samples [first, last] with one common level.
struct Block {
  double level;
  std::size_t first, last;
  double count() const { return static_cast<double>(last - first + 1); }
};

void pool(Block& into, const Block& next) {
  // Equal levels are not averaged, so that they stay the same to the bit.
  if (into.level != next.level)
    into.level = (into.level * into.count() + next.level * next.count()) / (into.count() + next.count());
  into.last = next.last;
}

// Isotonic regression: blocks with strictly increasing levels.
std::vector<Block> pooled(std::span<const double> way_m) {
  std::vector<Block> blocks;
  blocks.reserve(way_m.size());
  for (std::size_t i = 0; i < way_m.size(); ++i) {
    blocks.push_back({way_m[i], i, i});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].level >= blocks.back().level) {
      const Block last = blocks.back();
      blocks.pop_back();
      pool(blocks.back(), last);
    }
  }
  return blocks;
}

// The largest creep of block i: what its rounding can hide, and no further than its neighbours. A position
// without a quantum really rests, so it moves only as far as the inversion requires.
double largest_creep(std::span<const Block> blocks, std::size_t i, double quantum_m) {
  double gap = std::numeric_limits<double>::infinity();
  if (i > 0) gap = std::min(gap, blocks[i].level - blocks[i - 1].level);
  if (i + 1 < blocks.size()) gap = std::min(gap, blocks[i + 1].level - blocks[i].level);
  return quantum_m > 0 ? std::min(gap, quantum_m) : kLeastCreep * gap;
}

// Uniform motion by one quantum in n samples spans (1 - 1/n) quanta between the first and the last of them;
// half of that to each side.
double half_creep(std::span<const Block> blocks, std::size_t i, double quantum_m) {
  return largest_creep(blocks, i, quantum_m) / 2 * (1 - 1 / blocks[i].count());
}

void add_knot(MonotonePath& path, std::size_t sample, double way_m) {
  path.sample.push_back(static_cast<double>(sample));
  path.way_m.push_back(way_m);
}

void add_block(MonotonePath& path, const Block& block, double half) {
  add_knot(path, block.first, block.level - half);
  // A creep below the resolution of a double gives one knot for the block.
  if (block.level + half > block.level - half) add_knot(path, block.last, block.level + half);
}

double furthest_moved(const Block& block, std::span<const double> way_m, double half) {
  double moved = 0;
  for (std::size_t k = block.first; k <= block.last; ++k)
    moved = std::max(moved, std::abs(way_m[k] - block.level));
  return moved + half;
}

bool grows(std::span<const double> way_m) {
  return std::ranges::adjacent_find(way_m, std::greater_equal()) == way_m.end();
}

// The mean over `half` samples on each side, fewer near the ends.
std::vector<double> averaged(std::span<const double> values, std::size_t half) {
  const std::size_t n = values.size();
  std::vector<double> sums(n + 1, 0.0), means(n);
  for (std::size_t i = 0; i < n; ++i) sums[i + 1] = sums[i] + (values[i] - values.front());
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t reach = std::min({half, i, n - 1 - i});
    means[i] = values.front() + (sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1);
  }
  return means;
}

std::vector<double> twiced(std::span<const double> values, std::size_t half) {
  std::vector<double> once = averaged(values, half);
  const std::vector<double> again = averaged(once, half);
  for (std::size_t i = 0; i < once.size(); ++i) once[i] = 2 * once[i] - again[i];
  return once;
}

double furthest_apart(std::span<const double> a, std::span<const double> b) {
  double apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) apart = std::max(apart, std::abs(a[i] - b[i]));
  return apart;
}

MonotonePath path_through(std::span<const Block> blocks, std::span<const double> way_m, double creep_m) {
  MonotonePath path;
  path.sample.reserve(2 * blocks.size());
  path.way_m.reserve(2 * blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double half = half_creep(blocks, i, creep_m);
    add_block(path, blocks[i], half);
    path.moved_m = std::max(path.moved_m, furthest_moved(blocks[i], way_m, half));
  }
  return path;
}

// The way (position x direction) averaged over the longest window (2^k samples on each side, at most an
// eighth of all) that moves no position by more than 6 standard deviations of its noise; unchanged if there
// is none. An average A is applied as 2 A - A A (Tukey's twicing), which does not change a motion of
// constant acceleration. A window would blur slips after a stick, so the window stays short where there are
// any.
std::vector<double> smoothed_way(std::span<const double> way_m, double noise_m) {
  for (std::size_t half = std::bit_floor(way_m.size() / 16); half >= 1; half /= 2) {
    std::vector<double> smoothed = twiced(way_m, half);
    if (furthest_apart(smoothed, way_m) <= PositionError::kNoiseReach * noise_m) return smoothed;
  }
  return {way_m.begin(), way_m.end()};
}

}  // namespace

MonotonePath monotone_path(std::span<const double> position_m, int direction, PositionError error) {
  std::vector<double> way(position_m.begin(), position_m.end());
  for (double& position : way) position *= direction;
  const bool noisy = error.noise_m > 0 && !grows(way);
  const std::vector<Block> blocks = pooled(noisy ? smoothed_way(way, error.noise_m) : way);
  if (blocks.size() < 2) return {};
  return path_through(blocks, way, std::max(error.quantum_m, error.noise_m));
}

}  // namespace tacto::spatial
