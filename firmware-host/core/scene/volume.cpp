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
  for (int i = 0; i < 3; ++i) {
    const int64_t at = place.along[i] >> 32;
    if (at < 0 || at > static_cast<int64_t>(table.along[i].samples) - 2) return false;
    whole[i] = static_cast<uint32_t>(at);
    part[i] = static_cast<float>(static_cast<uint32_t>(place.along[i])) * 0x1p-32F;
  }
  cell = {(whole[2] * table.along[1].samples + whole[1]) * table.along[0].samples + whole[0], part[0],
          part[1], part[2]};
  return true;
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

// Differences of values are exact.
VolumeDepth depth_at(const VolumeTable& table, const int16_t* values, const VolumePlace& place) noexcept {
  Cell cell;
  if (!cell_of(table, place, cell)) return {};
  const uint32_t row = table.along[0].samples, layer = row * table.along[1].samples;
  float above[4], rise[4];  // over iso, and along x: of the rows at y z, y + 1 z, y z + 1, y + 1 z + 1
  for (uint32_t i = 0; i < 4; ++i) {
    const int16_t* const at = values + cell.first + (i & 1) * row + (i >> 1) * layer;
    rise[i] = static_cast<float>(at[1] - at[0]);
    above[i] = (static_cast<float>(at[0]) - table.iso) + cell.x * rise[i];
  }
  const float along_y[2] = {above[1] - above[0], above[3] - above[2]},
              at_z[2] = {above[0] + cell.y * along_y[0], above[2] + cell.y * along_y[1]},
              rise_at_z[2] = {rise[0] + cell.y * (rise[1] - rise[0]), rise[2] + cell.y * (rise[3] - rise[2])};
  const float along_z = at_z[1] - at_z[0];
  const auto out = [&](int axis, float per_sample) {
    return -table.m_per_value * table.along[axis].per_m * per_sample;
  };
  return {table.m_per_value * (at_z[0] + cell.z * along_z),
          {out(0, rise_at_z[0] + cell.z * (rise_at_z[1] - rise_at_z[0])),
           out(1, along_y[0] + cell.z * (along_y[1] - along_y[0])), out(2, along_z)}};
}

VolumeTouch touch_volume(const VolumeTable& table, const int32_t (&counts)[3]) noexcept {
  const VolumeDepth at = depth_at(table, values_of(table), place_in(table, counts));
  if (!(at.depth_m > 0)) return {{}, -at.depth_m};
  return {at.depth_m * at.outwards, 0};
}

}  // namespace tacto::core
