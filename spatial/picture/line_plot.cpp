// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/line_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/fitted_text.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/trace.hpp"

namespace tacto::spatial {

using schema::ErrorKind;
using schema::Result;

namespace {

constexpr double kPlotMargin = 14;
constexpr double kPlotLeft = 66;
constexpr double kBelow = 40;
constexpr double kLegend = 18, kLegendRow = 15;

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
      return schema::fail(ErrorKind::unsuitable, "x and y differ in length", "series '" + series.name + "'");
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const bool shown = figure.x_scale == AxisScale::linear || series.x[i] > 0;
      if (!shown || !std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      extents.x.add(series.x[i]);
      extents.y.add(series.y[i]);
    }
  }
  if (!(extents.x.low <= extents.x.high))
    return schema::fail(ErrorKind::unsuitable, "there is no finite point to draw",
                        "figure '" + figure.title + "'");
  return extents;
}

// Above the plot: heading, then the legend in as many rows as necessary, so that it never covers a curve.
struct PlotHead {
  struct Entry {
    std::size_t series;
    Point at;
  };
  Heading heading;
  std::vector<Entry> legend;
  double legend_height = kLegend;
  double extra() const { return heading.extra() + legend_height - kLegend; }
};

const TextStyle kLegendStyle{.size = 10};
constexpr double kLegendSample = 25, kLegendGap = 18;

void place_legend(Canvas& ruler, const LineFigure& figure, PlotHead& head) {
  const double right = figure.size.width - kPlotMargin;
  Point at{kPlotLeft, kPlotMargin + head.heading.height() + kLegend - 11};
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    if (figure.series[i].name.empty()) continue;
    const double width = kLegendSample + ruler.text_size(figure.series[i].name, kLegendStyle).width;
    if (at.x > kPlotLeft && at.x + width > right) {
      at = {kPlotLeft, at.y + kLegendRow};
      head.legend_height += kLegendRow;
    }
    head.legend.push_back({i, at});
    at.x += width + kLegendGap;
  }
}

PlotHead head_of(const LineFigure& figure) {
  Canvas ruler(PictureFormat::png, {1, 1});
  PlotHead head;
  head.heading =
      heading_of(figure.title, figure.subtitle, figure.simulated, figure.size.width - 2 * kPlotMargin);
  place_legend(ruler, figure, head);
  return head;
}

Box plot_box(const LineFigure& figure, const PlotHead& head) {
  const double top = kPlotMargin + head.heading.height() + head.legend_height;
  return {kPlotLeft, top, figure.size.width - kPlotLeft - kPlotMargin - 6,
          figure.size.height + head.extra() - top - kBelow - 4};
}

Axis x_axis_of(const LineFigure& figure, const Extent& extent, const Box& box) {
  Axis axis{figure.x_scale, extent.low, extent.high, 0, 0};
  const bool one_place = !(extent.high - extent.low > 1e-12 * std::abs(extent.high));
  const bool has_marks = std::ranges::any_of(figure.series, &Series::marks);  // not on the frame
  if (one_place || (has_marks && figure.x_scale == AxisScale::linear))
    axis = roomy_axis(extent.low, extent.high);
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

void draw_legend(Canvas& canvas, const LineFigure& figure, const PlotHead& head) {
  for (const auto& [index, at] : head.legend) {
    const Series& series = figure.series[index];
    canvas.line(at, {at.x + 20, at.y}, {series.colour, series.width + 0.75, series.dashed});
    draw_fitted(canvas, {at.x + kLegendSample, at.y}, series.name, kLegendStyle,
                figure.size.width - kPlotMargin - at.x - kLegendSample);
  }
}

void draw_series(Canvas& canvas, const LineFigure& figure, const Axis& x_axis, const Axis& y_axis) {
  for (const Series& series : figure.series) {
    if (series.marks) continue;
    for (const auto& piece : trace(series.x, series.y, x_axis, y_axis, canvas.pixels_per_point()))
      canvas.polyline(piece, {series.colour, series.width, series.dashed});
  }
}

bool boxes_overlap(const Box& a, const Box& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

// Marks and their labels. A label is left out if there is no space for it beside all marks and the labels
// before it. Curves are drawn below labels.
class Marks {
 public:
  Marks(Canvas& canvas, const Axis& x_axis, const Axis& y_axis, const Box& box)
      : canvas_(canvas), x_axis_(x_axis), y_axis_(y_axis), box_(box) {}

  void draw(const Series& series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const bool shown = x_axis_.scale == AxisScale::linear || series.x[i] > 0;
      if (!shown || !std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      const Point at{x_axis_.place(series.x[i]), y_axis_.place(series.y[i])};
      taken_.push_back({at.x - kHalf, at.y - kHalf, 2 * kHalf, 2 * kHalf});
      canvas_.fill(taken_.back(), series.colour);
      if (i < series.labels.size() && !series.labels[i].empty())
        pending_labels_.push_back({at, series.labels[i]});
    }
  }
  /// Precondition: all marks are drawn.
  void label() {
    for (const auto& [at, text] : pending_labels_) label(at, text);
  }

 private:
  // Tries the places above and below, right and left of the mark, then directly above and below.
  void label(Point at, const std::string& text) {
    const Size size = canvas_.text_size(text, kStyle);
    const double right = at.x + kBeside, left = at.x - kBeside - size.width, middle = at.x - size.width / 2;
    const double above = at.y - kBeside - size.height / 2, below = at.y + kBeside - size.height / 2;
    const double over = at.y - kBeside - size.height, under = at.y + kBeside;
    for (const Point corner : {Point{right, above}, Point{left, above}, Point{right, below},
                               Point{left, below}, Point{middle, over}, Point{middle, under}})
      if (const Box place{corner.x, corner.y, size.width, size.height}; is_free(place)) {
        taken_.push_back(place);
        canvas_.fill(place, {1, 1, 1});
        return canvas_.text({corner.x, corner.y + size.height / 2}, text, kStyle);
      }
  }
  bool is_free(const Box& place) const {
    const bool inside = place.x >= box_.x && place.right() <= box_.right() && place.y >= box_.y &&
                        place.bottom() <= box_.bottom();
    return inside &&
           std::ranges::none_of(taken_, [&](const Box& other) { return boxes_overlap(place, other); });
  }

  struct Asked {
    Point at;
    std::string text;
  };
  static constexpr double kHalf = 2.2, kBeside = 5;
  static constexpr TextStyle kStyle{.size = 8.5};
  Canvas& canvas_;
  const Axis &x_axis_, &y_axis_;
  const Box& box_;
  std::vector<Box> taken_;
  std::vector<Asked> pending_labels_;
};

}  // namespace

Size LineFigure::page() const {
  return {size.width, size.height + head_of(*this).extra()};
}

Result<void> LineFigure::draw(Canvas& canvas) const {
  const auto extents = extents_of(*this);
  TACTO_TRY(extents);
  const PlotHead head = head_of(*this);
  const Box box = plot_box(*this, head);
  const int rows = std::max(2, static_cast<int>(box.height / 36));
  const Axis x_axis = x_axis_of(*this, extents->x, box);
  const Axis y_axis = y_axis_of(extents->y, box);
  const auto x_ticks = ticks_of(x_axis, 10);
  const auto y_ticks = ticks_of(y_axis, rows);
  draw_heading(canvas, {kPlotMargin, kPlotMargin}, head.heading);
  draw_legend(canvas, *this, head);
  draw_grid(canvas, box, false, x_axis, x_ticks);
  draw_grid(canvas, box, true, y_axis, y_ticks);
  canvas.clip(box);
  draw_series(canvas, *this, x_axis, y_axis);
  canvas.release();
  Marks marks(canvas, x_axis, y_axis, box);
  for (const Series& each : series)
    if (each.marks) marks.draw(each);
  marks.label();
  canvas.frame(box, {});
  draw_axis(canvas, box, Side::bottom, x_axis, x_ticks);
  draw_axis(canvas, box, Side::left, y_axis, y_ticks);
  draw_caption(canvas, box, Side::bottom, x_label, 28);
  draw_caption(canvas, box, Side::left, y_label, 50);
  return {};
}

}  // namespace tacto::spatial
