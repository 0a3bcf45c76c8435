// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/valid_band.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "spatial/numbers/band_at.hpp"
#include "spatial/picture/draw/hatch.hpp"

namespace tacto::spatial {

using schema::BandPoint;

namespace {

// Clamped to the axis, because the band of a resting finger has infinite limits; everything is then outside
// it.
double place_of(const Axis& frequency, double per_m) {
  return frequency.place(std::clamp(1e-3 * per_m, frequency.low, frequency.high));
}

void draw_side(Canvas& canvas, const std::vector<Point>& limit, double edge) {
  std::vector<Point> outside = limit;
  outside.insert(outside.begin(), {limit.front().x, edge});
  outside.push_back({limit.back().x, edge});
  draw_hatch(canvas, outside);
  canvas.polyline(limit, kBandPen);
}

}  // namespace

void draw_valid_band(Canvas& canvas, const Box& area, std::span<const BandPoint> band, const Axis& position,
                     const Axis& frequency) {
  std::vector<Point> low;
  std::vector<Point> high;
  const int columns = std::max(1, static_cast<int>(area.width));
  for (int column = 0; column <= columns; ++column) {
    const double x = area.x + area.width * column / columns;
    const BandPoint at = band_at(band, 1e-3 * position.value(x));
    low.push_back({x, place_of(frequency, at.low_per_m)});
    high.push_back({x, place_of(frequency, at.high_per_m)});
  }
  canvas.clip(area);
  draw_side(canvas, low, area.bottom());
  draw_side(canvas, high, area.y);
  canvas.release();
}

}  // namespace tacto::spatial
