// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/monotone_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tacto::spatial {
namespace {

constexpr double kLeastCreep = 1e-3;

// Samples [first, last] that are given one level.
struct Block {
  double level;
  std::size_t first, last;
  double count() const { return static_cast<double>(last - first + 1); }
};

void pool(Block& into, const Block& next) {
  // Equal levels stay what they are to the bit.
  if (into.level != next.level)
    into.level = (into.level * into.count() + next.level * next.count()) / (into.count() + next.count());
  into.last = next.last;
}

// Isotonic regression: blocks with strictly increasing levels.
std::vector<Block> pooled(std::span<const double> position_m, int direction) {
  std::vector<Block> blocks;
  blocks.reserve(position_m.size());
  for (std::size_t i = 0; i < position_m.size(); ++i) {
    blocks.push_back({direction * position_m[i], i, i});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].level >= blocks.back().level) {
      const Block last = blocks.back();
      blocks.pop_back();
      pool(blocks.back(), last);
    }
  }
  return blocks;
}

// How far block i may creep: what its rounding hides, and no further than its neighbours. Where no quantum
// shows, it stands still in truth and moves only so much that it can be inverted.
double room_of(std::span<const Block> blocks, std::size_t i, double quantum_m) {
  double gap = std::numeric_limits<double>::infinity();
  if (i > 0) gap = std::min(gap, blocks[i].level - blocks[i - 1].level);
  if (i + 1 < blocks.size()) gap = std::min(gap, blocks[i + 1].level - blocks[i].level);
  return quantum_m > 0 ? std::min(gap, quantum_m) : kLeastCreep * gap;
}

// An even motion of one quantum in n samples, seen in n samples, spans (1 - 1/n) quanta: half of it to each
// side.
double half_creep(std::span<const Block> blocks, std::size_t i, double quantum_m) {
  return room_of(blocks, i, quantum_m) / 2 * (1 - 1 / blocks[i].count());
}

void add_knot(MonotonePath& path, std::size_t sample, double way_m) {
  path.sample.push_back(static_cast<double>(sample));
  path.way_m.push_back(way_m);
}

void add_block(MonotonePath& path, const Block& block, double half) {
  add_knot(path, block.first, block.level - half);
  // Where the creep is below what a double resolves there, one knot stands for the block.
  if (block.level + half > block.level - half) add_knot(path, block.last, block.level + half);
}

double furthest_moved(const Block& block, std::span<const double> position_m, int direction, double half) {
  double moved = 0;
  for (std::size_t k = block.first; k <= block.last; ++k)
    moved = std::max(moved, std::abs(direction * position_m[k] - block.level));
  return moved + half;
}

}  // namespace

MonotonePath monotone_path(std::span<const double> position_m, int direction, double quantum_m) {
  const std::vector<Block> blocks = pooled(position_m, direction);
  MonotonePath path;
  if (blocks.size() < 2) return path;
  path.sample.reserve(2 * blocks.size());
  path.way_m.reserve(2 * blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double half = half_creep(blocks, i, quantum_m);
    add_block(path, blocks[i], half);
    path.moved_m = std::max(path.moved_m, furthest_moved(blocks[i], position_m, direction, half));
  }
  return path;
}

}  // namespace tacto::spatial
