// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/volume.hpp"

namespace tacto::core {
namespace {

// The cell of a place: its first value, and the parts of the way to the next ones.
struct Cell {
  uint32_t first = 0;
  float x = 0, y = 0, z = 0;
};

bool cell_of(const VolumeTable& table, const VolumePlace& place, Cell& cell) noexcept {
  uint32_t whole[3];
  float part[3];
  bool within = true;
  for (int i = 0; i < 3; ++i) {
    whole[i] = static_cast<uint32_t>(static_cast<uint64_t>(place.along[i]) >> 32);  // below 0: a large one
    within = within && whole[i] < table.along[i].samples - 1;
    part[i] = static_cast<float>(static_cast<uint32_t>(place.along[i])) * 0x1p-32F;
  }
  cell = {(whole[2] * table.along[1].samples + whole[1]) * table.along[0].samples + whole[0], part[0],
          part[1], part[2]};
  return within;
}

// Of the interpolant: over iso, and its gradient per sample.
struct Level {
  float above = 0;
  SpaceVector rise;
};

// Differences of values are exact.
Level level_at(const VolumeTable& table, const int16_t* values, const Cell& cell) noexcept {
  const uint32_t row = table.along[0].samples, layer = row * table.along[1].samples;
  float above[4], rise[4];  // over iso, and along x: of the rows at y z, y + 1 z, y z + 1, y + 1 z + 1
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t first = cell.first + (i & 1) * row + (i >> 1) * layer;
    const int16_t* const at = values + first;
    rise[i] = static_cast<float>(at[1] - at[0]);
    above[i] = (static_cast<float>(at[0]) - table.iso) + cell.x * rise[i];
  }
  const float along_y[2] = {above[1] - above[0], above[3] - above[2]},
              at_z[2] = {above[0] + cell.y * along_y[0], above[2] + cell.y * along_y[1]},
              rise_at_z[2] = {rise[0] + cell.y * (rise[1] - rise[0]), rise[2] + cell.y * (rise[3] - rise[2])};
  const float along_z = at_z[1] - at_z[0];
  return {at_z[0] + cell.z * along_z,
          {rise_at_z[0] + cell.z * (rise_at_z[1] - rise_at_z[0]),
           along_y[0] + cell.z * (along_y[1] - along_y[0]), along_z}};
}

// From values per sample to m per m.
SpaceVector outwards(const VolumeTable& table, SpaceVector rise) noexcept {
  const auto out = [&](int axis, float per_sample) {
    return -table.m_per_value * table.along[axis].per_m * per_sample;
  };
  return {out(0, rise.x), out(1, rise.y), out(2, rise.z)};
}

VolumePlace moved(const VolumePlace& hand, const ToolPoint& point) noexcept {
  VolumePlace place;
  for (int i = 0; i < 3; ++i)
    place.along[i] =
        static_cast<int64_t>(static_cast<uint64_t>(hand.along[i]) + joined(point.whole[i], point.part[i]));
  return place;
}

// Of the block of a place between values.
int16_t largest_at(const VolumeTable& table, const VolumePlace& place) noexcept {
  uint32_t block[3];
  for (int i = 0; i < 3; ++i)
    block[i] = static_cast<uint32_t>(static_cast<uint64_t>(place.along[i]) >> 32) / kVolumeBlock;
  const uint32_t row = blocks_of(table.along[0]), layer = row * blocks_of(table.along[1]);
  return largest_of_blocks(table)[block[2] * layer + block[1] * row + block[0]];
}

// Whole values; the rest is kept for the next tick that carves.
int32_t fall_of_tick(VolumeTable& table) noexcept {
  const uint32_t sum = table.carve_rest + table.carve_per_tick;
  table.carve_rest = sum & 0xFFFF;
  return static_cast<int32_t>(sum >> 16);
}

void carve(const VolumeTable& table, const Cell& cell, int32_t fall, int16_t* values) noexcept {
  const uint32_t row = table.along[0].samples, layer = row * table.along[1].samples;
  for (uint32_t i = 0; i < 8; ++i) {
    int16_t& value = values[cell.first + (i & 1) + (i >> 1 & 1) * row + (i >> 2) * layer];
    const int32_t least = value < table.carve_to ? value : table.carve_to, lower = value - fall;
    value = static_cast<int16_t>(lower > least ? lower : least);
  }
}

}  // namespace

VolumePlace place_in(const VolumeTable& table, const int32_t (&counts)[3]) noexcept {
  VolumePlace place;
  for (int i = 0; i < 3; ++i) {
    const VolumeAxis& axis = table.along[i];
    const auto from =
        static_cast<int32_t>(static_cast<uint32_t>(counts[i]) - static_cast<uint32_t>(table.piece.origin[i]));
    place.along[i] = static_cast<int64_t>(joined(axis.whole, axis.part) +
                                          static_cast<uint64_t>(static_cast<int64_t>(from)) *
                                              joined(axis.whole_per_count, axis.part_per_count));
  }
  return place;
}

VolumeDepth depth_at(const VolumeTable& table, const int16_t* values, const VolumePlace& place) noexcept {
  Cell cell;
  if (!cell_of(table, place, cell)) return {};
  const Level level = level_at(table, values, cell);
  return {table.m_per_value * level.above, outwards(table, level.rise)};
}

// Half of the points of a tool are outside or more, and their values, which are all over the memory, take
// most of the time: of those the block's largest value is read alone. Others have no branch on which of them
// are inside: they are read while others are on their way from memory.
VolumeTouch touch_volume(VolumeTable& table, const int32_t (&counts)[3], float stiffness) noexcept {
  auto* const values = const_cast<int16_t*>(values_of(table));
  const VolumePlace hand = place_in(table, counts);
  const ToolPoint origin, *const points = table.points > 0 ? points_of(table) : &origin;
  const float low = table.iso - kLetGo_m / table.m_per_value - 1;  // 1: more than rounding
  SpaceVector sum;
  float highest = -1e30F;
  int32_t fall = -1;  // of this tick, once for all points
  for (uint32_t i = 0; i == 0 || i < table.points; ++i) {
    Cell cell;
    const VolumePlace place = moved(hand, points[i]);
    if (!cell_of(table, place, cell)) continue;
    if (table.points > 0 && static_cast<float>(largest_at(table, place)) < low) continue;
    const Level level = level_at(table, values, cell);
    highest = level.above > highest ? level.above : highest;
    const SpaceVector push = (level.above > 0 ? level.above : 0) * level.rise;
    sum = sum + push;
    if (!(table.carve_n > 0)) continue;
    if (!(stiffness * length(table.m_per_value * outwards(table, push)) > table.carve_n)) continue;
    if (fall < 0) fall = fall_of_tick(table);
    carve(table, cell, fall, values);
  }
  return {table.m_per_value * outwards(table, sum), highest > 0 ? 0 : -table.m_per_value * highest};
}

}  // namespace tacto::core
