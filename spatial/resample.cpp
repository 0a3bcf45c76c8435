// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "data-schema/quantity.hpp"
#include "spatial/dsp/hermite.hpp"
#include "spatial/dsp/hermite_inverse.hpp"

namespace tacto::spatial {
namespace {

constexpr double kMostSamples = 1e9;
// A position that lies on the grid is on it, whatever its rounding. In pitches.
constexpr double kOnGrid = 1e-6;
constexpr std::size_t kBlock = 2048;

}  // namespace

schema::Result<SpaceGrid> grid_along(const MonotonePath& path, int direction, double pitch_m) {
  using schema::Fault;
  const auto [low_m, high_m] = std::minmax({direction * path.way_m.front(), direction * path.way_m.back()});
  const double first = std::ceil(low_m / pitch_m - kOnGrid), last = std::floor(high_m / pitch_m + kOnGrid);
  const auto text = [](double m) { return schema::for_people(m, schema::Dimension::length); };
  if (last - first < 1)
    return schema::fail(Fault::unsuitable,
                        fmt::format("the stroke's {} lie between two points of the grid of {}",
                                    text(high_m - low_m), text(pitch_m)),
                        {}, "choose a finer --grid");
  if (last - first >= kMostSamples)
    return schema::fail(
        Fault::unsuitable,
        fmt::format("a grid of {} on {} is more than 1e9 samples", text(pitch_m), text(high_m - low_m)), {},
        "choose a coarser --grid");
  return SpaceGrid{pitch_m, first, static_cast<std::size_t>(last - first) + 1};
}

std::vector<double> resample(const MonotonePath& path, int direction, const SpaceGrid& grid,
                             std::span<const double> values, std::size_t margin) {
  const HermiteInverse sample_at(path.sample, path.way_m);
  const UniformHermiteCurve value_at(-static_cast<double>(margin), 1, values);
  std::vector<double> result(grid.count);
  std::array<double, kBlock> way, sample;
  // Along the way the path is walked once; a backward stroke meets the grid from its far end.
  const auto index = [&](std::size_t k) { return direction > 0 ? k : grid.count - 1 - k; };
  for (std::size_t begin = 0; begin < grid.count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, grid.count - begin);
    for (std::size_t k = 0; k < size; ++k) way[k] = direction * grid.position_m(index(begin + k));
    sample_at.evaluate_sorted(std::span(way).first(size), std::span(sample).first(size));
    for (std::size_t k = 0; k < size; ++k) result[index(begin + k)] = value_at(sample[k]);
  }
  return result;
}

}  // namespace tacto::spatial
