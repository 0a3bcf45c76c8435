// SPDX-License-Identifier: GPL-3.0-or-later
// One page to draw on, as PNG or SVG; the interface to Cairo and Pango. Both formats show the same drawing.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "spatial/picture/draw/geometry.hpp"
#include "spatial/picture/draw/style.hpp"

namespace tacto::spatial {

class Page;

/// Errors are stored until encode(). Not shared between threads; not safe in the tick.
class Canvas {
 public:
  Canvas(PictureFormat format, Size page);
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;
  ~Canvas();

  /// Resolution of rasters and curves.
  double pixels_per_point() const;

  void fill(const Box& box, const Colour& colour);
  void frame(const Box& box, const Pen& pen);
  void line(Point from, Point to, const Pen& pen);
  /// Draws many lines in one stroke, because an SVG repeats the clip for each stroke.
  void lines(std::span<const Segment> lines, const Pen& pen);
  void polyline(std::span<const Point> points, const Pen& pen);
  void polygon(std::span<const Point> points, const Colour& colour);
  /// Fills the box; without smoothing if the pixels match those of the PNG.
  void image(const Box& box, const Pixels& pixels);
  void text(Point at, const std::string& text, const TextStyle& style);
  Size text_size(const std::string& text, const TextStyle& style);
  /// Restricts drawing to the box until release().
  void clip(const Box& box);
  void clip(std::span<const Point> polygon);
  void release();

  /// The finished file. In an SVG, letters are outlines, so that they look the same everywhere, below a
  /// transparent layer of text that can be searched and copied. Errors: internal, with Cairo's message.
  schema::Result<std::string> encode();

 private:
  PictureFormat format_;
  std::unique_ptr<Page> page_;
  std::string text_layer_;
};

}  // namespace tacto::spatial
