// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/canvas.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "spatial/picture/draw/engine.hpp"
#include "spatial/picture/draw/svg_numbers.hpp"

namespace tacto::spatial {
namespace {

// Replaces a page if the module cannot be loaded: it draws nothing, and encode() returns the error.
class NoPage : public Page {
 public:
  void fill(const Box&, const Colour&) override {}
  void frame(const Box&, const Pen&) override {}
  void lines(std::span<const Segment>, const Pen&) override {}
  void polyline(std::span<const Point>, const Pen&) override {}
  void polygon(std::span<const Point>, const Colour&) override {}
  void image(const Box&, const Pixels&, std::string) override {}
  Size text_size(const std::string&, const TextStyle&) override { return {}; }
  TextExtent text(Point, const std::string&, const TextStyle&, bool) override { return {}; }
  void clip(const Box&) override {}
  void clip(std::span<const Point>) override {}
  void release() override {}
  schema::Result<std::string> encode() override { return schema::forward_error(drawing_engine()); }
};

std::unique_ptr<Page> page_for(PictureFormat format, Size size) {
  const auto& engine = drawing_engine();
  if (!engine) return std::make_unique<NoPage>();
  return (*engine)->page(format == PictureFormat::png, size);
}

// A text that was drawn: `start` is the left end of its baseline, relative to `at` after rotation.
struct PlacedText {
  std::string text;
  Point at, start;
  double width = 0;
  TextStyle style;
};

std::string escaped(std::string_view text) {
  std::string xml;
  for (const char c : text) {
    if (c == '&')
      xml += "&amp;";
    else if (c == '<')
      xml += "&lt;";
    else if (c == '>')
      xml += "&gt;";
    else if (static_cast<unsigned char>(c) >= ' ')
      xml += c;
  }
  return xml;
}

// The <text> element, in XML.
std::string svg_text(const PlacedText& placed) {
  const Colour& colour = placed.style.colour;
  const auto part = [](double value) { return static_cast<int>(std::lround(255 * value)); };
  return fmt::format(
      "<text transform=\"translate({:.2f} {:.2f}){}\" x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:g}\" "
      "fill=\"#{:02x}{:02x}{:02x}\"{} textLength=\"{:.2f}\" lengthAdjust=\"spacingAndGlyphs\">{}</text>\n",
      placed.at.x, placed.at.y, placed.style.upward ? " rotate(-90)" : "", placed.start.x, placed.start.y,
      placed.style.size, part(colour.red), part(colour.green), part(colour.blue),
      placed.style.bold ? " font-weight=\"bold\"" : "", placed.width, escaped(placed.text));
}

// On a dark page the picture is inverted, with its hues kept; a raster is inverted back. In an <img>, too,
// the page's colour scheme decides.
constexpr std::string_view kDark =
    "<style>@media (prefers-color-scheme: dark) { svg, image { filter: invert(1) hue-rotate(180deg); } "
    "}</style>\n";

// The SVG with the elements in a group before its end: transparent, over letters that are drawn as outlines,
// or `visible`, instead of them.
std::string with_text_layer(std::string svg, std::string_view elements, bool visible) {
  const auto end = svg.rfind("</svg>");
  if (end == std::string::npos) return svg;
  svg.insert(end, fmt::format("{}<g{} font-family=\"'DejaVu Sans', Verdana, sans-serif\">\n{}</g>\n",
                              visible ? kDark : "", visible ? "" : " fill-opacity=\"0\"", elements));
  return svg;
}

}  // namespace

Canvas::Canvas(PictureFormat format, Size page) : format_(format), page_(page_for(format, page)) {
  fill({0, 0, page.width, page.height}, {1, 1, 1});
}
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;
Canvas::~Canvas() = default;

double Canvas::pixels_per_point() const {
  return format_ == PictureFormat::page_svg ? kWebPixelsPerPoint : kPixelsPerPoint;
}

void Canvas::fill(const Box& box, const Colour& colour) {
  page_->fill(box, colour);
}

void Canvas::frame(const Box& box, const Pen& pen) {
  page_->frame(box, pen);
}

void Canvas::line(Point from, Point to, const Pen& pen) {
  const Point ends[] = {from, to};
  polyline(ends, pen);
}

void Canvas::lines(std::span<const Segment> lines, const Pen& pen) {
  page_->lines(lines, pen);
}

void Canvas::polyline(std::span<const Point> points, const Pen& pen) {
  page_->polyline(points, pen);
}

void Canvas::polygon(std::span<const Point> points, const Colour& colour) {
  page_->polygon(points, colour);
}

void Canvas::image(const Box& box, const Pixels& pixels) {
  page_->image(box, pixels, format_ == PictureFormat::png ? "" : palette_png(pixels));
}

Size Canvas::text_size(const std::string& text, const TextStyle& style) {
  return page_->text_size(text, style);
}

void Canvas::text(Point at, const std::string& text, const TextStyle& style) {
  const auto [size, baseline] = page_->text(at, text, style, format_ != PictureFormat::page_svg);
  const Point start{-style.align_x * size.width, -style.align_y * size.height + baseline};
  if (format_ != PictureFormat::png) text_layer_ += svg_text({text, at, start, size.width, style});
}

void Canvas::clip(const Box& box) {
  page_->clip(box);
}

void Canvas::clip(std::span<const Point> polygon) {
  page_->clip(polygon);
}

void Canvas::release() {
  page_->release();
}

schema::Result<std::string> Canvas::encode() {
  auto bytes = page_->encode();
  if (!bytes || format_ == PictureFormat::png) return bytes;
  return with_text_layer(with_rounded_paths(*bytes), text_layer_, format_ == PictureFormat::page_svg);
}

}  // namespace tacto::spatial
