// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/axes.hpp"

#include <algorithm>

namespace tacto::spatial {
namespace {

constexpr double kMajorTick = 4;
constexpr double kMinorTick = 2;
constexpr double kLabelGap = 6;
const Pen kTickPen{kInk, 0.75};

Point outwards(const Box& box, Side side, double place, double distance) {
  if (side == Side::left) return {box.x - distance, place};
  if (side == Side::right) return {box.right() + distance, place};
  return {place, box.bottom() + distance};
}

TextStyle label_style(Side side) {
  TextStyle style;
  style.size = kTickLabelSize;
  if (side == Side::left) style.align_x = 1;
  if (side == Side::bottom) style = {.size = kTickLabelSize, .align_x = 0.5, .align_y = 0};
  return style;
}

// A row of tick labels; a label that would touch the one before it is left out.
class LabelRow {
 public:
  LabelRow(Canvas& canvas, const Box& box, Side side) : canvas_(canvas), box_(box), side_(side) {}

  void add(double place, const std::string& label) {
    const TextStyle style = label_style(side_);
    const Size size = canvas_.text_size(label, style);
    const double half = 0.5 * (side_ == Side::bottom ? size.width + 6 : size.height - 3);
    if (used_ && place - half < end_ && place + half > start_) return;
    start_ = used_ ? std::min(start_, place - half) : place - half;
    end_ = used_ ? std::max(end_, place + half) : place + half;
    used_ = true;
    canvas_.text(outwards(box_, side_, place, kLabelGap), label, style);
  }

 private:
  Canvas& canvas_;
  Box box_;
  Side side_;
  double start_ = 0, end_ = 0;
  bool used_ = false;
};

}  // namespace

void draw_axis(Canvas& canvas, const Box& box, Side side, const Axis& axis, const std::vector<Tick>& ticks) {
  LabelRow labels(canvas, box, side);
  std::vector<Segment> marks;
  for (const Tick& tick : ticks) {
    const double place = axis.place(tick.value);
    const double reach = tick.label.empty() ? kMinorTick : kMajorTick;
    marks.push_back({outwards(box, side, place, 0), outwards(box, side, place, reach)});
    if (!tick.label.empty()) labels.add(place, tick.label);
  }
  canvas.lines(marks, kTickPen);
}

void draw_caption(Canvas& canvas, const Box& box, Side side, const std::string& caption, double gap) {
  const double middle = side == Side::bottom ? box.x + box.width / 2 : box.y + box.height / 2;
  TextStyle style{.size = kCaptionSize, .align_x = 0.5, .upward = side != Side::bottom};
  canvas.text(outwards(box, side, middle, gap), caption, style);
}

void draw_grid(Canvas& canvas, const Box& box, bool across, const Axis& axis,
               const std::vector<Tick>& ticks) {
  std::vector<Segment> lines;
  for (const Tick& tick : ticks) {
    if (tick.label.empty()) continue;
    const double place = axis.place(tick.value);
    if (across)
      lines.push_back({{box.x, place}, {box.right(), place}});
    else
      lines.push_back({{place, box.y}, {place, box.bottom()}});
  }
  canvas.lines(lines, {kGridLine, 0.5});
}

}  // namespace tacto::spatial
