// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/hatch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tacto::spatial {
namespace {

constexpr Colour kVeil{0.92, 0.92, 0.94, 0.62};
const Pen kHatchPen{{0.25, 0.25, 0.30, 0.55}, 0.4};
constexpr double kSpacing = 5;

Box bounds_of(std::span<const Point> points) {
  const auto [left, right] = std::ranges::minmax(points, {}, &Point::x);
  const auto [top, bottom] = std::ranges::minmax(points, {}, &Point::y);
  return {left.x, top.y, right.x - left.x, bottom.y - top.y};
}

}  // namespace

void draw_hatch(Canvas& canvas, std::span<const Point> polygon) {
  if (polygon.empty()) return;
  canvas.polygon(polygon, kVeil);
  canvas.clip(polygon);
  // Lines x + y = n * spacing, which are the same on the whole page for any polygon.
  const Box box = bounds_of(polygon);
  const double first = std::ceil((box.x + box.y) / kSpacing) * kSpacing;
  std::vector<Segment> lines;
  for (double sum = first; sum <= box.right() + box.bottom(); sum += kSpacing)
    lines.push_back({{sum - box.bottom(), box.bottom()}, {sum - box.y, box.y}});
  canvas.lines(lines, kHatchPen);
  canvas.release();
}

void draw_hatch(Canvas& canvas, const Box& box) {
  const Point corners[] = {
      {box.x, box.y}, {box.right(), box.y}, {box.right(), box.bottom()}, {box.x, box.bottom()}};
  draw_hatch(canvas, corners);
}

}  // namespace tacto::spatial
