// SPDX-License-Identifier: GPL-3.0-or-later
// Points and boxes on a page. Lengths in typographic points (1/72 inch), y grows downwards.
#pragma once

#include <cstdint>
#include <vector>

namespace tacto::spatial {

struct Point {
  double x = 0, y = 0;
};

struct Segment {
  Point from, to;
};

struct Size {
  double width = 0, height = 0;
};

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

/// Red, green, blue and opacity, 0 to 1.
struct Colour {
  double red = 0, green = 0, blue = 0, alpha = 1;
};

/// Rows of 0x00RRGGBB from the top left.
struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint32_t> rgb;
};

}  // namespace tacto::spatial
