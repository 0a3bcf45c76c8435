// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/spectrogram_layout.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/heading.hpp"

namespace tacto::spatial {
namespace {

constexpr double kPageWidth = 800;
constexpr double kMargin = 14;
constexpr double kOnePanel = 500;
constexpr double kOneOfSeveral = 400;

double panel_height(std::size_t panels) {
  return panels == 1 ? kOnePanel : kOneOfSeveral;
}

double on_pixel(double place) {
  return std::round(place * kPixelsPerPoint) / kPixelsPerPoint;
}

}  // namespace

double heading_width() {
  return kPageWidth - 2 * kMargin;
}

Size page_of(std::span<const double> heading_heights) {
  double height = 0;
  for (const double heading : heading_heights)
    height += panel_height(heading_heights.size()) + heading - kHeadingHeight;
  return {kPageWidth, height};
}

PanelLayout panel_layout(std::size_t panel, std::span<const double> heading_heights) {
  const std::size_t panels = heading_heights.size();
  double panel_top = static_cast<double>(panel) * panel_height(panels);
  for (const double above : heading_heights.first(panel)) panel_top += above - kHeadingHeight;
  const double heading = heading_heights[panel];
  const double top = panel_top + kMargin, plots = top + heading;
  const double bottom = panel_top + panel_height(panels) + heading - kHeadingHeight;
  const double trace_height = panels == 1 ? 100 : 84;
  const double heat_top = plots + trace_height + 12;
  const double heat_height = bottom - 46 - heat_top;
  PanelLayout layout;
  layout.heading = {kMargin, top, heading_width(), heading};
  layout.trace = {66, plots, 488, trace_height};
  layout.heat = {66, heat_top, 488, heat_height};
  layout.mean = {620, heat_top, 92, heat_height};
  layout.bar = {730, heat_top, 12, heat_height};
  layout.notes = {620, plots, kPageWidth - kMargin - 620, trace_height};
  return layout;
}

Axis position_axis(double low_mm, double high_mm, const Box& box) {
  return {AxisScale::linear, low_mm, high_mm, box.x, box.right()};
}

Axis frequency_axis(double low_per_mm, double high_per_mm, const Box& box) {
  return {AxisScale::logarithmic, low_per_mm, high_per_mm, box.bottom(), box.y};
}

Box covered(const Box& heat, const Axis& position_mm, const schema::Spectrogram& spectrogram) {
  const double half_hop = 0.5 * spectrogram.hop_m;
  const double left = position_mm.place(1e3 * (spectrogram.position_m.front() - half_hop));
  const double right = position_mm.place(1e3 * (spectrogram.position_m.back() + half_hop));
  const double from = on_pixel(std::max(left, heat.x));
  const double to = std::max(on_pixel(std::min(right, heat.right())), from + 1 / kPixelsPerPoint);
  return {from, heat.y, to - from, heat.height};
}

}  // namespace tacto::spatial
