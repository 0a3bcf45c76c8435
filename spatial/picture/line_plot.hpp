// SPDX-License-Identifier: GPL-3.0-or-later
// Curves on common axes, with a legend, e.g. target and result over time or position.
#pragma once

#include <string>
#include <vector>

#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/colours.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::spatial {

/// One curve, in the units of the axes' labels. A value that is not finite interrupts it.
struct Series {
  std::string name;  ///< for the legend; empty: not in it
  std::vector<double> x, y;
  Colour colour;
  double width = 1;
  bool dashed = false;
  bool marks = false;                    ///< a mark at each point instead of a curve
  std::vector<std::string> labels = {};  ///< beside the marks, if there is space; at most as many as points
};

struct LineFigure : Figure {
  std::string title, subtitle;
  std::string x_label, y_label;  ///< with units: "position (mm)"
  std::string simulated;         ///< the source of simulated data, for the badge
  std::vector<Series> series;
  AxisScale x_scale = AxisScale::linear;
  Size size{700, 320};  ///< with title and badge on one line each; longer ones make the page higher

  Size page() const override;
  /// Errors: unsuitable, if no series has a finite point, or x and y differ in length.
  schema::Result<void> draw(Canvas& canvas) const override;
};

}  // namespace tacto::spatial
