// SPDX-License-Identifier: GPL-3.0-or-later
// Formats of a page, and styles of its lines and letters.
#pragma once

#include "spatial/picture/draw/colours.hpp"

namespace tacto::spatial {

/// `page_svg`: an SVG for a web page. The resolution of its rasters and curves is that of a screen, and
/// letters are text in the reader's font (DejaVu Sans, or one of equal widths) instead of outlines.
enum class PictureFormat { png, svg, page_svg };

/// Pixels of a PNG for each point of the page: a page 800 points wide has 1600 pixels.
inline constexpr double kPixelsPerPoint = 2;

/// The same within an SVG for a web page, which is shown with about 1.2 pixels per point: sixty pictures of
/// noise, which have the largest files, then make 9 MB.
inline constexpr double kWebPixelsPerPoint = 1.1;

struct Pen {
  Colour colour = kInk;
  double width = 0.75;
  bool dashed = false;
};

/// The position of a text relative to its point. align_x 0: the point is its left end, 0.5 its middle, 1 its
/// right end; align_y 0: its top, 1: its bottom. Both are relative to the reading direction, also of vertical
/// text.
struct TextStyle {
  double size = 9;
  Colour colour = kInk;
  bool bold = false;
  double align_x = 0;
  double align_y = 0.5;
  bool upward = false;
};

}  // namespace tacto::spatial
