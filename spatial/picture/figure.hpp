// SPDX-License-Identifier: GPL-3.0-or-later
// A drawing of one page, made once and written as PNG or SVG alike.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

class Canvas;

/// What can be drawn. Sizes in points; a PNG has two pixels a point.
class Figure {
 public:
  virtual ~Figure() = default;
  virtual Size page() const = 0;
  /// Errors: what the figure says of its data.
  virtual schema::Result<void> draw(Canvas& canvas) const = 0;
};

/// The figure as a file in memory. Inline several of these SVGs in one page only as images (data: URIs):
/// their inner names are alike. Errors: the figure's own; unsuitable, where the page has more than 32,767
/// pixels a side.
schema::Result<std::string> to_png(const Figure& figure);
schema::Result<std::string> to_svg(const Figure& figure);

/// The SVG for a web page: rasters and curves as fine as a screen shows them, in a quarter of the bytes.
schema::Result<std::string> to_page_svg(const Figure& figure);

/// By the path's extension, .png or .svg. Errors: usage, for another one, naming those there are.
schema::Result<std::string> encode_as(const std::string& path, const Figure& figure);

/// Encodes by extension and adds to files that appear together. Errors: those of encode_as; cannot_write.
schema::Result<void> add_figure(schema::PendingFiles& files, const std::string& path, const Figure& figure);

/// The same for one file. Errors: those of add_figure.
schema::Result<void> write_figure(const std::string& path, const Figure& figure);

}  // namespace tacto::spatial
