// SPDX-License-Identifier: GPL-3.0-or-later
// A drawing of one page that can be written as PNG or SVG.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"
#include "spatial/picture/draw/geometry.hpp"

namespace tacto::spatial {

class Canvas;

/// A drawing. Sizes in points; a PNG has two pixels per point.
class Figure {
 public:
  virtual ~Figure() = default;
  virtual Size page() const = 0;
  /// Errors: those of the figure about its data.
  virtual schema::Result<void> draw(Canvas& canvas) const = 0;
};

/// The figure as a file in memory. Put several of these SVGs on one web page only as images (data: URIs),
/// because their inner names are the same. Errors: the figure's own; unsuitable, if the page has more than
/// 32,767 pixels on a side.
schema::Result<std::string> to_png(const Figure& figure);
schema::Result<std::string> to_svg(const Figure& figure);

/// The SVG for a web page: the resolution of rasters and curves is that of a screen, which needs a quarter of
/// the bytes.
schema::Result<std::string> to_page_svg(const Figure& figure);

/// By the path's extension, .png or .svg. Errors: usage, for another one, with the list of extensions.
schema::Result<std::string> encode_as(const std::string& path, const Figure& figure);

/// Encodes by extension and adds the file to those that appear together. Errors: those of encode_as;
/// cannot_write.
schema::Result<void> add_figure(schema::PendingFiles& files, const std::string& path, const Figure& figure);

/// The same for one file. Errors: those of add_figure.
schema::Result<void> write_figure(const std::string& path, const Figure& figure);

}  // namespace tacto::spatial
