// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/canvas.hpp"

#include "spatial/picture/draw/engine.hpp"
#include "spatial/picture/draw/svg_numbers.hpp"
#include "spatial/picture/draw/svg_text.hpp"

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
