// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/line_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "spatial/picture/axes.hpp"
#include "spatial/picture/canvas.hpp"
#include "spatial/picture/heading.hpp"
#include "spatial/picture/trace.hpp"

namespace tacto::spatial {

using schema::Fault;
using schema::Result;

namespace {

constexpr double kPlotMargin = 14;
constexpr double kPlotLeft = 66;
constexpr double kBelow = 40;
constexpr double kLegend = 18;

struct Extent {
  double low = INFINITY, high = -INFINITY;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

struct Extents {
  Extent x, y;
};

Result<Extents> extents_of(const LineFigure& figure) {
  Extents extents;
  for (const Series& series : figure.series) {
    if (series.x.size() != series.y.size())
      return schema::fail(Fault::unsuitable, "x and y differ in length", "series '" + series.name + "'");
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const bool shown = figure.x_scale == AxisScale::linear || series.x[i] > 0;
      if (!shown || !std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      extents.x.add(series.x[i]);
      extents.y.add(series.y[i]);
    }
  }
  if (!(extents.x.low <= extents.x.high))
    return schema::fail(Fault::unsuitable, "there is no finite point to draw",
                        "figure '" + figure.title + "'");
  return extents;
}

Box plot_box(const LineFigure& figure) {
  const double top = kPlotMargin + kHeadingHeight + kLegend;
  return {kPlotLeft, top, figure.size.width - kPlotLeft - kPlotMargin - 6,
          figure.size.height - top - kBelow - 4};
}

Axis x_axis_of(const LineFigure& figure, const Extent& extent, const Box& box) {
  Axis axis{figure.x_scale, extent.low, extent.high, 0, 0};
  if (!(extent.high - extent.low > 1e-12 * std::abs(extent.high))) axis = roomy_axis(extent.low, extent.high);
  axis.at_low = box.x;
  axis.at_high = box.right();
  return axis;
}

Axis y_axis_of(const Extent& extent, const Box& box) {
  Axis axis = roomy_axis(extent.low, extent.high);
  axis.at_low = box.bottom();
  axis.at_high = box.y;
  return axis;
}

// Above the plot, from the left: no curve is ever under it.
void draw_legend(Canvas& canvas, const LineFigure& figure, const Box& box) {
  const TextStyle style{.size = 10};
  Point at{box.x, box.y - 11};
  for (const Series& series : figure.series) {
    if (series.name.empty()) continue;
    canvas.line(at, {at.x + 20, at.y}, {series.colour, series.width + 0.75, series.dashed});
    canvas.text({at.x + 25, at.y}, series.name, style);
    at.x += 25 + canvas.text_size(series.name, style).width + 18;
  }
}

void draw_series(Canvas& canvas, const LineFigure& figure, const Axis& x_axis, const Axis& y_axis) {
  for (const Series& series : figure.series) {
    if (series.marks) continue;
    for (const auto& piece : trace(series.x, series.y, x_axis, y_axis))
      canvas.polyline(piece, {series.colour, series.width, series.dashed});
  }
}

bool boxes_overlap(const Box& a, const Box& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

// Marks, and as many of their labels as find room beside those before them: above and to the right, in the
// plot's right part to the left.
class Marks {
 public:
  Marks(Canvas& canvas, const Axis& x_axis, const Axis& y_axis, const Box& box)
      : canvas_(canvas), x_axis_(x_axis), y_axis_(y_axis), box_(box) {}

  void draw(const Series& series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const bool shown = x_axis_.scale == AxisScale::linear || series.x[i] > 0;
      if (!shown || !std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      const Point at{x_axis_.place(series.x[i]), y_axis_.place(series.y[i])};
      canvas_.fill({at.x - kHalf, at.y - kHalf, 2 * kHalf, 2 * kHalf}, series.colour);
      if (i < series.labels.size() && !series.labels[i].empty()) label(at, series.labels[i]);
    }
  }

 private:
  void label(Point at, const std::string& text) {
    const bool left = at.x > box_.x + 0.7 * box_.width;
    const TextStyle style{.size = 7.5, .align_x = left ? 1.0 : 0.0};
    const Size size = canvas_.text_size(text, style);
    const double x = at.x + (left ? -kBeside : kBeside), y = at.y - kBeside;
    const Box place{left ? x - size.width : x, y - size.height / 2, size.width, size.height};
    if (std::ranges::any_of(taken_, [&](const Box& other) { return boxes_overlap(place, other); })) return;
    taken_.push_back(place);
    canvas_.text({x, y}, text, style);
  }

  static constexpr double kHalf = 2.2, kBeside = 5;
  Canvas& canvas_;
  const Axis &x_axis_, &y_axis_;
  const Box& box_;
  std::vector<Box> taken_;
};

}  // namespace

Colour series_colour(std::size_t index) {
  constexpr std::array<Colour, 6> kSeriesColours = {{{0.000, 0.447, 0.698},
                                                     {0.835, 0.369, 0.000},
                                                     {0.000, 0.620, 0.451},
                                                     {0.800, 0.475, 0.655},
                                                     {0.337, 0.706, 0.914},
                                                     {0.902, 0.624, 0.000}}};
  return kSeriesColours[index % kSeriesColours.size()];
}

Result<void> LineFigure::draw(Canvas& canvas) const {
  const auto extents = extents_of(*this);
  if (!extents) return schema::forward_error(extents);
  const Box box = plot_box(*this);
  const int rows = std::max(2, static_cast<int>(box.height / 36));
  const Axis x_axis = x_axis_of(*this, extents->x, box);
  const Axis y_axis = y_axis_of(extents->y, box);
  const auto x_ticks = ticks_of(x_axis, 10);
  const auto y_ticks = ticks_of(y_axis, rows);
  draw_heading(canvas, {kPlotMargin, kPlotMargin, size.width - 2 * kPlotMargin, kHeadingHeight}, title,
               subtitle, simulated);
  draw_legend(canvas, *this, box);
  draw_grid(canvas, box, false, x_axis, x_ticks);
  draw_grid(canvas, box, true, y_axis, y_ticks);
  canvas.clip(box);
  draw_series(canvas, *this, x_axis, y_axis);
  canvas.release();
  Marks marks(canvas, x_axis, y_axis, box);
  for (const Series& each : series)
    if (each.marks) marks.draw(each);
  canvas.frame(box, {});
  draw_axis(canvas, box, Side::bottom, x_axis, x_ticks);
  draw_axis(canvas, box, Side::left, y_axis, y_ticks);
  draw_caption(canvas, box, Side::bottom, x_label, 28);
  draw_caption(canvas, box, Side::left, y_label, 50);
  return {};
}

}  // namespace tacto::spatial
