// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/relief.hpp"

#include <stddef.h>

#include "firmware-host/core/kernel/level_of_detail.hpp"

namespace tacto::core {
namespace {

// Weights of the four coefficients around a place, and their derivatives (Unser 1999, table 1, degree 3).
struct SplineWeights {
  float value[4], slope[4];

  explicit SplineWeights(float t) noexcept {
    const float r = 1 - t, tt = t * t, rr = r * r;
    value[0] = rr * r * (1.0F / 6);
    value[1] = (4 - 6 * tt + 3 * tt * t) * (1.0F / 6);
    value[2] = (4 - 6 * rr + 3 * rr * r) * (1.0F / 6);
    value[3] = tt * t * (1.0F / 6);
    slope[0] = -0.5F * rr;
    slope[1] = t * (1.5F * t - 2);
    slope[2] = -r * (1.5F * r - 2);
    slope[3] = 0.5F * tt;
  }
};

uint32_t held_within(int64_t index, uint32_t count) noexcept {
  if (index < 0) return 0;
  return index < static_cast<int64_t>(count) ? static_cast<uint32_t>(index) : count - 1;
}

// The sixteen coefficients around a place, among those of a level, and their weights.
struct Neighbours {
  SplineWeights along_x, along_y;
  uint32_t columns[4];
  size_t rows[4];

  Neighbours(const ReliefLevel& level, LatticePlace x, LatticePlace y) noexcept
      : along_x(x.part), along_y(y.part) {
    for (int i = 0; i < 4; ++i) {
      columns[i] = held_within(static_cast<int64_t>(x.cell) - 1 + i, level.columns);
      rows[i] =
          static_cast<size_t>(held_within(static_cast<int64_t>(y.cell) - 1 + i, level.rows)) * level.columns;
    }
  }
};

}  // namespace

void values_at(const ReliefLevel& level, size_t second, Q32 x, Q32 y, float (&values)[2]) noexcept {
  const Neighbours at(level, lattice_place(x), lattice_place(y));
  values[0] = values[1] = 0;
  for (int j = 0; j < 4; ++j) {
    const float* const row = level.coefficients + at.rows[j];
    float first_sum = 0, second_sum = 0;
    for (int i = 0; i < 4; ++i) {
      first_sum += at.along_x.value[i] * row[at.columns[i]];
      second_sum += at.along_x.value[i] * row[second + at.columns[i]];
    }
    values[0] += at.along_y.value[j] * first_sum;
    values[1] += at.along_y.value[j] * second_sum;
  }
}

ReliefSample relief_at(const ReliefLevel& level, Q32 x_place, Q32 y_place) noexcept {
  const Neighbours at(level, lattice_place(x_place), lattice_place(y_place));
  const SplineWeights &along_x = at.along_x, &along_y = at.along_y;
  const auto& columns = at.columns;
  const float* rows[4];
  for (int i = 0; i < 4; ++i) rows[i] = level.coefficients + at.rows[i];
  const float near = rows[1][columns[1]];
  ReliefSample sample{near, 0, 0};
  for (int j = 0; j < 4; ++j) {
    float value = 0, slope = 0;
    for (int i = 0; i < 4; ++i) {
      const float above = rows[j][columns[i]] - near;
      value += along_x.value[i] * above;
      slope += along_x.slope[i] * above;
    }
    sample.value += along_y.value[j] * value;
    sample.by_x += along_y.value[j] * slope;
    sample.by_y += along_y.slope[j] * value;
  }
  return sample;
}

CurvedSample curved_relief_at(const ReliefLevel& level, Q32 x_place, Q32 y_place) noexcept {
  const LatticePlace x = lattice_place(x_place), y = lattice_place(y_place);
  const Neighbours at(level, x, y);
  const float bend_x[4] = {1 - x.part, 3 * x.part - 2, 1 - 3 * x.part, x.part},
              bend_y[4] = {1 - y.part, 3 * y.part - 2, 1 - 3 * y.part, y.part};
  const float near = level.coefficients[at.rows[1] + at.columns[1]];
  CurvedSample sample;
  sample.value = near;
  for (int j = 0; j < 4; ++j) {
    float value = 0, slope = 0, bend = 0;
    for (int i = 0; i < 4; ++i) {
      const float above = level.coefficients[at.rows[j] + at.columns[i]] - near;
      value += at.along_x.value[i] * above;
      slope += at.along_x.slope[i] * above;
      bend += bend_x[i] * above;
    }
    sample.value += at.along_y.value[j] * value;
    sample.by_x += at.along_y.value[j] * slope;
    sample.by_y += at.along_y.slope[j] * value;
    sample.by_xx += at.along_y.value[j] * bend;
    sample.by_xy += at.along_y.slope[j] * slope;
    sample.by_yy += bend_y[j] * value;
  }
  return sample;
}

PlayedLevels played_levels(const ReliefTable& table, float speed_mps, float rate_hz) noexcept {
  const float cycles_per_tick = speed_mps * table.highest_per_m / rate_hz;
  const Detail detail = detail_at(cycles_per_tick * (1 / kWholeReliefPerTick));
  return {detail.coarser, {1 - detail.fade, detail.fade}};
}

}  // namespace tacto::core
