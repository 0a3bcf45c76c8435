// SPDX-License-Identifier: GPL-3.0-or-later
// One page to draw on, as PNG or SVG: the door to Cairo and Pango. What is drawn is the same in both.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

/// `page_svg`: an SVG for a web page: rasters and curves are as fine as a screen shows them, letters are text
/// in the reader's font (DejaVu Sans, or one of equal widths) instead of outlines.
enum class PictureFormat { png, svg, page_svg };

/// Pixels of a PNG for each point of the page: a page 800 points wide has 1600 pixels.
inline constexpr double kPixelsPerPoint = 2;

/// The same within an SVG for a web page, which shows a point on about 1.2 pixels: sixty pictures of noise,
/// the largest, then make 9 MB.
inline constexpr double kWebPixelsPerPoint = 1.1;

struct Pen {
  Colour colour = kInk;
  double width = 0.75;
  bool dashed = false;
};

/// How a text stands at its point. align_x 0: the point is its left end, 0.5 its middle, 1 its right end;
/// align_y 0: its top, 1: its bottom; both as read, also where the text runs upwards.
struct TextStyle {
  double size = 9;
  Colour colour = kInk;
  bool bold = false;
  double align_x = 0;
  double align_y = 0.5;
  bool upward = false;
};

/// Errors are kept until encode(). Not shared between threads; not safe in the tick.
class Canvas {
 public:
  Canvas(PictureFormat format, Size page);
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;
  ~Canvas();

  /// How finely rasters and curves are drawn.
  double pixels_per_point() const;

  void fill(const Box& box, const Colour& colour);
  void frame(const Box& box, const Pen& pen);
  void line(Point from, Point to, const Pen& pen);
  /// Many lines in one stroke: an SVG repeats the clip for each stroke.
  void lines(std::span<const Segment> lines, const Pen& pen);
  void polyline(std::span<const Point> points, const Pen& pen);
  void polygon(std::span<const Point> points, const Colour& colour);
  /// Fills the box; without smoothing where the pixels match the PNG's.
  void image(const Box& box, const Pixels& pixels);
  void text(Point at, const std::string& text, const TextStyle& style);
  Size text_size(const std::string& text, const TextStyle& style);
  /// Only what lies in it is drawn, until release().
  void clip(const Box& box);
  void clip(std::span<const Point> polygon);
  void release();

  /// The finished file. In an SVG, letters are outlines, so that they look the same everywhere, under a
  /// transparent layer of text that can be searched and copied. Errors: internal, by Cairo's words.
  schema::Result<std::string> encode();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tacto::spatial
