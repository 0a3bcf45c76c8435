// SPDX-License-Identifier: GPL-3.0-or-later
// The head of a figure: title, subtitle, and the badge of simulated data. All of it is shown: texts that are
// too long for a line wrap and make the head higher.
#pragma once

#include <string>
#include <vector>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// Height in points of a head with one line for each text.
inline constexpr double kHeadingHeight = 42;

struct Heading {
  std::vector<std::string> title, subtitle, badge;  ///< lines
  bool badge_beside = false;  ///< the badge is to the right of the title, otherwise above it
  double width = 0;

  double height() const;
  /// Height in excess of kHeadingHeight.
  double extra() const { return height() - kHeadingHeight; }
};

/// Breaks the texts into lines for a head of that width. `simulated` names the source of simulated data;
/// empty: no badge.
Heading heading_of(const std::string& title, const std::string& subtitle, const std::string& simulated,
                   double width);

void draw_heading(Canvas& canvas, Point top_left, const Heading& heading);

}  // namespace tacto::spatial
