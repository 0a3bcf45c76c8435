// SPDX-License-Identifier: GPL-3.0-or-later
// The head of a figure: title, the facts below it, and the badge of simulated data. All of it is shown: texts
// that are too long for a line wrap, and the head grows.
#pragma once

#include <string>
#include <vector>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// Height of a head whose texts each fit on their line, in points.
inline constexpr double kHeadingHeight = 42;

struct Heading {
  std::vector<std::string> title, subtitle, badge;  ///< lines
  bool badge_beside = false;                        ///< the badge stands right of the title, else above it
  double width = 0;

  double height() const;
  /// How much higher than kHeadingHeight.
  double extra() const { return height() - kHeadingHeight; }
};

/// Breaks the texts into lines for a head of that width. `simulated` says by what; empty: no badge.
Heading heading_of(const std::string& title, const std::string& subtitle, const std::string& simulated,
                   double width);

void draw_heading(Canvas& canvas, Point top_left, const Heading& heading);

}  // namespace tacto::spatial
