// SPDX-License-Identifier: GPL-3.0-or-later
// The part of the plane that a picture shows, and its place on the page.
#pragma once

#include <algorithm>
#include <cmath>

#include "analysis/scene/relief_raster.hpp"
#include "spatial/picture/draw/axis.hpp"

namespace tacto::analysis {

/// A rectangle of the plane that grows with what is added, in metres.
struct PlaneRange {
  double left_m = INFINITY, right_m = -INFINITY, low_m = INFINITY, high_m = -INFINITY;

  void add(spatial::Point place_m) {
    left_m = std::min(left_m, place_m.x), right_m = std::max(right_m, place_m.x);
    low_m = std::min(low_m, place_m.y), high_m = std::max(high_m, place_m.y);
  }
};

/// Equal scales along x and y, in mm on the axes.
struct SceneMap {
  spatial::Box box;
  spatial::Axis x, y;
  PixelGrid grid;

  spatial::Point place(spatial::Point place_m) const {
    return {x.place(1e3 * place_m.x), y.place(1e3 * place_m.y)};
  }
  double points_per_m() const { return box.width / (grid.columns * grid.pixel_m); }
};

/// The range with a margin around it, within a box of at most this size at `top_left`. Precondition: a range
/// to which something was added.
SceneMap scene_map(const PlaneRange& range, spatial::Point top_left, spatial::Size most);

}  // namespace tacto::analysis
