// SPDX-License-Identifier: GPL-3.0-or-later
// Curves over one axis, with a legend: what was wanted against what came, over time or position.
#pragma once

#include <string>
#include <vector>

#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::spatial {

/// One curve, in the units that the axes' labels name. A value that is not finite interrupts it.
struct Series {
  std::string name;  ///< for the legend; empty: not in it
  std::vector<double> x, y;
  Colour colour;
  double width = 1;
  bool dashed = false;
  bool marks = false;  ///< a mark at each point, in place of a curve
  std::vector<std::string> labels =
      {};  ///< beside the marks, where there is room; as many as points, or fewer
};

/// Colours that stay apart for colour-blind people and in grey (Okabe and Ito 2008): blue, vermilion, green,
/// ...
Colour series_colour(std::size_t index);

struct LineFigure : Figure {
  std::string title, subtitle;
  std::string x_label, y_label;  ///< with units: "position (mm)"
  std::string simulated;         ///< by what, where it is simulated: said in the picture
  std::vector<Series> series;
  AxisScale x_scale = AxisScale::linear;
  Size size{700, 320};  ///< with a title and a badge on one line; longer ones make the page higher

  Size page() const override;
  /// Errors: unsuitable, where no series has a finite point, or x and y differ in length.
  schema::Result<void> draw(Canvas& canvas) const override;
};

}  // namespace tacto::spatial
