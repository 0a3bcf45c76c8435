// SPDX-License-Identifier: GPL-3.0-or-later
// Points, boxes and colours on a page. Lengths in typographic points (1/72 inch), y grows downwards.
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

inline constexpr Colour kInk{0.10, 0.10, 0.12};
inline constexpr Colour kGreyInk{0.38, 0.38, 0.42};
inline constexpr Colour kGridLine{0.86, 0.86, 0.88};
inline constexpr Colour kAlarm{0.76, 0.20, 0.10};

}  // namespace tacto::spatial
