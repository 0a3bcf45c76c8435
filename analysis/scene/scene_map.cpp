// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/scene_map.hpp"

#include "spatial/picture/draw/style.hpp"

namespace tacto::analysis {

using spatial::kPixelsPerPoint;

SceneMap scene_map(const PlaneRange& range, spatial::Point top_left, spatial::Size most) {
  constexpr double kMargin = 0.04, kFlattest = 0.2;  // of the longer side
  double width_m = range.right_m - range.left_m, height_m = range.high_m - range.low_m;
  const double longer_m = std::max({width_m, height_m, 1e-6});
  width_m = std::max(width_m, kFlattest * longer_m) + 2 * kMargin * longer_m;
  height_m = std::max(height_m, kFlattest * longer_m) + 2 * kMargin * longer_m;
  const double points_per_m = std::min(most.width / width_m, most.height / height_m);
  SceneMap map;
  map.grid.pixel_m = 1 / (points_per_m * kPixelsPerPoint);
  map.grid.columns = static_cast<int>(std::lround(width_m / map.grid.pixel_m));
  map.grid.rows = static_cast<int>(std::lround(height_m / map.grid.pixel_m));
  width_m = map.grid.columns * map.grid.pixel_m;
  height_m = map.grid.rows * map.grid.pixel_m;
  map.grid.left_m = (range.left_m + range.right_m - width_m) / 2;
  map.grid.top_m = (range.low_m + range.high_m + height_m) / 2;
  map.box = {top_left.x, top_left.y, map.grid.columns / kPixelsPerPoint, map.grid.rows / kPixelsPerPoint};
  map.x = {spatial::AxisScale::linear, 1e3 * map.grid.left_m, 1e3 * (map.grid.left_m + width_m), map.box.x,
           map.box.right()};
  map.y = {spatial::AxisScale::linear, 1e3 * (map.grid.top_m - height_m), 1e3 * map.grid.top_m,
           map.box.bottom(), map.box.y};
  return map;
}

}  // namespace tacto::analysis
