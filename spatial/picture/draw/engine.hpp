// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of the libraries that draw (Cairo, Pango, libpng, OpenCV). They depend on 60 libraries, and
// loading them takes longer than most commands; so they are linked to a module, which is loaded with the
// first picture.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "spatial/picture/draw/geometry.hpp"
#include "spatial/picture/draw/style.hpp"

namespace tacto::spatial {

/// Size of a drawn text, and the distance of its baseline below its top.
struct TextExtent {
  Size size;
  double baseline = 0;
};

/// A page of Cairo. Canvas documents each function.
class Page {
 public:
  Page() = default;
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;
  virtual ~Page() = default;

  virtual void fill(const Box& box, const Colour& colour) = 0;
  virtual void frame(const Box& box, const Pen& pen) = 0;
  virtual void lines(std::span<const Segment> lines, const Pen& pen) = 0;
  virtual void polyline(std::span<const Point> points, const Pen& pen) = 0;
  virtual void polygon(std::span<const Point> points, const Colour& colour) = 0;
  /// `png`: the same pixels as a PNG, which an SVG contains instead of the one that Cairo makes; may be
  /// empty.
  virtual void image(const Box& box, const Pixels& pixels, std::string png) = 0;
  virtual Size text_size(const std::string& text, const TextStyle& style) = 0;
  /// Returns the extent of the text, and draws it if `drawn`.
  virtual TextExtent text(Point at, const std::string& text, const TextStyle& style, bool drawn) = 0;
  virtual void clip(const Box& box) = 0;
  virtual void clip(std::span<const Point> polygon) = 0;
  virtual void release() = 0;
  /// Errors: internal, with Cairo's message.
  virtual schema::Result<std::string> encode() = 0;
};

/// A spectrogram to be drawn: `cells` are rows of `bins`. The lower and the upper end of the axis, in bins.
struct HeatmapJob {
  std::span<const float> cells;
  int rows = 0, bins = 0;
  double low_bin = 0, high_bin = 0;
  double factor = 1, decade_db = 10;  ///< level: decade_db log10(factor cell)
  double low_db = 0, high_db = 0;     ///< levels of the first and the last colour
  int width = 0, height = 0;          ///< pixels
};

struct DrawingEngine {
  std::unique_ptr<Page> (*page)(bool png, Size size);
  std::string (*palette_png)(const Pixels& pixels);
  /// The colour of a level, 0 for the darkest, 1 for the brightest.
  std::uint32_t (*shade)(double part);
  schema::Result<Pixels> (*heatmap)(const HeatmapJob& job);
};

inline constexpr const char* kPictureModule = "tactograph-pictures.so";
inline constexpr const char* kPictureEntry = "tacto_drawing_engine";
using PictureEntry = const DrawingEngine* (*)();

/// Loaded at the first call. Errors: internal, with the loader's message.
const schema::Result<const DrawingEngine*>& drawing_engine();

/// A raster of few colours as a PNG with a palette, which has a third of the bytes of one with three
/// channels: the same pixels, without loss. Empty if there are more than 256 colours, or after an error of
/// libpng.
std::string palette_png(const Pixels& pixels);

}  // namespace tacto::spatial
