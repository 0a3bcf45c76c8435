// SPDX-License-Identifier: Apache-2.0
// A point, or a tool of many points, in a volume of voxels: the depth below the surface of one value, and its
// gradient, of one interpolant (Massie 1996; McNeely 1999).
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "firmware-host/core/scene/piece.hpp"

namespace tacto::core {

inline constexpr uint32_t kMostVolumeSamples = 4096;  ///< along an axis
inline constexpr uint32_t kMostToolPoints = 1000;

/// An axis of a volume: samples against counts of the encoder, from the origin of the piece on.
struct VolumeAxis {
  int32_t whole = 0;  ///< of the place of the origin, in samples: whole + part 2^-32
  uint32_t part = 0;
  int32_t whole_per_count = 0;
  uint32_t part_per_count = 0;
  float per_m = 0;       ///< samples per metre
  uint32_t samples = 0;  ///< at least 2
};
static_assert(sizeof(VolumeAxis) == 24);

/// This, then the points of the tool, then the values: i16, those along x next to each other, then along y,
/// then along z; two in a word. With a tool then the largest values of its blocks, in the same order.
struct VolumeTable {
  PieceTable piece;  ///< its form is not used: a unit vector and the half extent
  VolumeAxis along[3];
  float iso = 0;                ///< the value of the surface
  float m_per_value = 0;        ///< of the depth
  float carve_n = 0;            ///< force of the spring above which the point removes material; 0: never
  uint32_t carve_per_tick = 0;  ///< how much then the eight values around it fall, x 2^16
  int32_t carve_to = 0;         ///< no value falls below this one
  uint32_t carve_rest = 0;      ///< of carve_per_tick: what the last fall left; 0 in a block
  uint32_t points = 0;          ///< of the tool; 0: the hand is the point
};
static_assert(sizeof(VolumeTable) == 200);

/// From the hand, in samples along x, y and z: whole + part 2^-32.
struct ToolPoint {
  int32_t whole[3] = {};
  uint32_t part[3] = {};
};
static_assert(sizeof(ToolPoint) == 24);

inline const ToolPoint* points_of(const VolumeTable& table) noexcept {
  return reinterpret_cast<const ToolPoint*>(&table + 1);
}

inline uint32_t value_words_of(const VolumeTable& table) noexcept {
  return (table.along[0].samples * table.along[1].samples * table.along[2].samples + 1) / 2;
}

/// A block is this many cells along each axis, the last one fewer; a cell is between two values.
inline constexpr uint32_t kVolumeBlock = 8;

inline uint32_t blocks_of(const VolumeAxis& axis) noexcept {
  return (axis.samples + kVolumeBlock - 2) / kVolumeBlock;
}

/// Of the largest values of the blocks, i16.
inline uint32_t block_words_of(const VolumeTable& table) noexcept {
  const VolumeAxis* const along = table.along;
  return table.points > 0 ? (blocks_of(along[0]) * blocks_of(along[1]) * blocks_of(along[2]) + 1) / 2 : 0;
}

inline const int16_t* values_of(const VolumeTable& table) noexcept {
  return reinterpret_cast<const int16_t*>(points_of(table) + table.points);
}

/// Precondition: with a tool. Not below any value that a point in the block reads: values only fall.
inline const int16_t* largest_of_blocks(const VolumeTable& table) noexcept {
  return values_of(table) + 2 * static_cast<size_t>(value_words_of(table));
}

/// A place in samples, each 2^-32 of one.
struct VolumePlace {
  int64_t along[3] = {};
};

/// Of a hand that is within kFarthestInSpace_m of the origin. Exact but for 2^-33 samples per count. Safe in
/// the tick.
VolumePlace place_in(const VolumeTable& table, const int32_t (&counts)[3]) noexcept;

/// The depth at a place and minus its gradient along x, y and z, which leads outwards.
struct VolumeDepth {
  float depth_m = -1e30F;  ///< (value - iso) x m_per_value
  SpaceVector outwards;    ///< in m per m
};

/// The trilinear interpolant of the eight values around a place, and its exact gradient; beyond the outermost
/// samples, far outside. Safe in the tick.
VolumeDepth depth_at(const VolumeTable& table, const int16_t* values, const VolumePlace& place) noexcept;

struct VolumeTouch {
  SpaceVector push_m;       ///< sum over the points: depth x its gradient, outwards; 0 outside
  float outside_m = 1e30F;  ///< minus the largest depth, or more than kLetGo_m; 0 inside
};

/// With the stiffness K the force is K x push_m, the gradient of the potential K depth^2 / 2 of the depths
/// above 0, summed over the points: so a closed path gains no energy. Where that of a point is above carve_n
/// the values around it fall, from the next point on: a potential that falls gives no energy either. Of a
/// tool, points in blocks whose values are all more than kLetGo_m outside are not looked at. A table with
/// carve_n is in the kernel's own memory (SceneView::as_in()). Safe in the tick: one step per point.
VolumeTouch touch_volume(VolumeTable& table, const int32_t (&counts)[3], float stiffness) noexcept;

}  // namespace tacto::core
