// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/canvas.hpp"

#include <cairo-svg.h>
#include <cairo.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "spatial/picture/draw/palette_png.hpp"
#include "spatial/picture/draw/svg_numbers.hpp"
#include "spatial/picture/draw/svg_text.hpp"

namespace tacto::spatial {
namespace {

template <auto release>
struct Releaser {
  template <class T>
  void operator()(T* object) const {
    release(object);
  }
};
using Surface = std::unique_ptr<cairo_surface_t, Releaser<cairo_surface_destroy>>;
using Cairo = std::unique_ptr<cairo_t, Releaser<cairo_destroy>>;
using Layout = std::unique_ptr<PangoLayout, Releaser<g_object_unref>>;
using Font = std::unique_ptr<PangoFontDescription, Releaser<pango_font_description_free>>;
using FontOptions = std::unique_ptr<cairo_font_options_t, Releaser<cairo_font_options_destroy>>;

cairo_status_t append(void* text, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

int pixels(double points) {
  return static_cast<int>(std::lround(points * kPixelsPerPoint));
}

Surface make_surface(PictureFormat format, Size page, std::string& bytes) {
  if (format == PictureFormat::png)
    return Surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(page.width), pixels(page.height)));
  return Surface(cairo_svg_surface_create_for_stream(append, &bytes, page.width, page.height));
}

// No hinting: it would move letters by fractions of a pixel, differently in PNG and SVG.
FontOptions unhinted() {
  FontOptions options(cairo_font_options_create());
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  return options;
}

void release_bytes(void* bytes) {
  delete static_cast<std::string*>(bytes);
}

// What an SVG shall hold in place of the PNG with three channels that Cairo makes.
void attach_png(cairo_surface_t* surface, std::string png) {
  if (png.empty()) return;
  auto bytes = std::make_unique<std::string>(std::move(png));
  const auto* data = reinterpret_cast<const unsigned char*>(bytes->data());
  const auto attached = cairo_surface_set_mime_data(surface, CAIRO_MIME_TYPE_PNG, data, bytes->size(),
                                                    release_bytes, bytes.get());
  if (attached == CAIRO_STATUS_SUCCESS) static_cast<void>(bytes.release());
}

}  // namespace

struct Canvas::State {
  State(PictureFormat target, Size size)
      : format(target), page(size), surface(make_surface(target, size, bytes)) {
    cairo.reset(cairo_create(surface.get()));
    if (format == PictureFormat::png) cairo_scale(cairo.get(), kPixelsPerPoint, kPixelsPerPoint);
    cairo_set_line_join(cairo.get(), CAIRO_LINE_JOIN_ROUND);
    layout.reset(pango_cairo_create_layout(cairo.get()));
    PangoContext* const context = pango_layout_get_context(layout.get());
    pango_cairo_context_set_font_options(context, unhinted().get());
    pango_cairo_context_set_resolution(context, 72);
    pango_context_set_round_glyph_positions(context, FALSE);
  }

  void ink(const Colour& colour) {
    cairo_set_source_rgba(cairo.get(), colour.red, colour.green, colour.blue, colour.alpha);
  }

  void stroke(const Pen& pen) {
    constexpr double kDash[] = {4, 2.5};
    ink(pen.colour);
    cairo_set_line_width(cairo.get(), pen.width);
    cairo_set_dash(cairo.get(), kDash, pen.dashed ? 2 : 0, 0);
    cairo_stroke(cairo.get());
  }

  void path(std::span<const Point> points) {
    cairo_new_path(cairo.get());
    for (const Point& point : points) cairo_line_to(cairo.get(), point.x, point.y);
  }

  Size set_text(const std::string& text, const TextStyle& style) {
    const Font font(pango_font_description_from_string("DejaVu Sans"));
    pango_font_description_set_size(font.get(), static_cast<int>(std::lround(style.size * PANGO_SCALE)));
    pango_font_description_set_weight(font.get(), style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_layout_set_font_description(layout.get(), font.get());
    pango_layout_set_text(layout.get(), text.c_str(), static_cast<int>(text.size()));
    int width = 0;
    int height = 0;
    pango_layout_get_size(layout.get(), &width, &height);
    return {pango_units_to_double(width), pango_units_to_double(height)};
  }

  PictureFormat format;
  Size page;
  std::string bytes;  // before the surface, which writes to it until it is destroyed
  std::string text_layer;
  Surface surface;
  Cairo cairo;
  Layout layout;
};

Canvas::Canvas(PictureFormat format, Size page) : state_(std::make_unique<State>(format, page)) {
  fill({0, 0, page.width, page.height}, {1, 1, 1});
}
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;
Canvas::~Canvas() = default;

double Canvas::pixels_per_point() const {
  return state_->format == PictureFormat::page_svg ? kWebPixelsPerPoint : kPixelsPerPoint;
}

void Canvas::fill(const Box& box, const Colour& colour) {
  state_->ink(colour);
  cairo_rectangle(state_->cairo.get(), box.x, box.y, box.width, box.height);
  cairo_fill(state_->cairo.get());
}

void Canvas::frame(const Box& box, const Pen& pen) {
  cairo_rectangle(state_->cairo.get(), box.x, box.y, box.width, box.height);
  state_->stroke(pen);
}

void Canvas::line(Point from, Point to, const Pen& pen) {
  const Point ends[] = {from, to};
  polyline(ends, pen);
}

void Canvas::lines(std::span<const Segment> lines, const Pen& pen) {
  cairo_new_path(state_->cairo.get());
  for (const Segment& line : lines) {
    cairo_move_to(state_->cairo.get(), line.from.x, line.from.y);
    cairo_line_to(state_->cairo.get(), line.to.x, line.to.y);
  }
  state_->stroke(pen);
}

void Canvas::polyline(std::span<const Point> points, const Pen& pen) {
  state_->path(points);
  state_->stroke(pen);
}

void Canvas::polygon(std::span<const Point> points, const Colour& colour) {
  state_->path(points);
  state_->ink(colour);
  cairo_fill(state_->cairo.get());
}

void Canvas::image(const Box& box, const Pixels& pixels) {
  cairo_t* cairo = state_->cairo.get();
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels.width, pixels.height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return;
  unsigned char* rows = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  const auto width = static_cast<std::size_t>(pixels.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(pixels.height); ++y)
    std::memcpy(rows + y * stride, pixels.rgb.data() + y * width, width * sizeof(std::uint32_t));
  cairo_surface_mark_dirty(surface.get());
  if (state_->format != PictureFormat::png) attach_png(surface.get(), palette_png(pixels));
  cairo_save(cairo);
  cairo_translate(cairo, box.x, box.y);
  cairo_scale(cairo, box.width / pixels.width, box.height / pixels.height);
  cairo_set_source_surface(cairo, surface.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
  cairo_rectangle(cairo, 0, 0, pixels.width, pixels.height);
  cairo_fill(cairo);
  cairo_restore(cairo);
}

Size Canvas::text_size(const std::string& text, const TextStyle& style) {
  return state_->set_text(text, style);
}

void Canvas::text(Point at, const std::string& text, const TextStyle& style) {
  cairo_t* cairo = state_->cairo.get();
  const Size size = state_->set_text(text, style);
  const Point corner{-style.align_x * size.width, -style.align_y * size.height};
  const double baseline = pango_units_to_double(pango_layout_get_baseline(state_->layout.get()));
  if (state_->format != PictureFormat::png)
    state_->text_layer += svg_text({text, at, {corner.x, corner.y + baseline}, size.width, style});
  if (state_->format == PictureFormat::page_svg) return;
  cairo_save(cairo);
  cairo_translate(cairo, at.x, at.y);
  if (style.upward) cairo_rotate(cairo, -std::numbers::pi / 2);
  cairo_move_to(cairo, corner.x, corner.y);
  state_->ink(style.colour);
  pango_cairo_show_layout(cairo, state_->layout.get());
  cairo_restore(cairo);
}

void Canvas::clip(const Box& box) {
  cairo_save(state_->cairo.get());
  cairo_rectangle(state_->cairo.get(), box.x, box.y, box.width, box.height);
  cairo_clip(state_->cairo.get());
}

void Canvas::clip(std::span<const Point> polygon) {
  cairo_save(state_->cairo.get());
  state_->path(polygon);
  cairo_clip(state_->cairo.get());
}

void Canvas::release() {
  cairo_restore(state_->cairo.get());
}

schema::Result<std::string> Canvas::encode() {
  State& state = *state_;
  if (state.format == PictureFormat::png)
    cairo_surface_write_to_png_stream(state.surface.get(), append, &state.bytes);
  cairo_surface_finish(state.surface.get());
  for (const cairo_status_t status :
       {cairo_status(state.cairo.get()), cairo_surface_status(state.surface.get())})
    if (status != CAIRO_STATUS_SUCCESS && status != CAIRO_STATUS_SURFACE_FINISHED)
      return schema::fail(schema::ErrorKind::internal, cairo_status_to_string(status), "picture");
  if (state.format == PictureFormat::png) return state.bytes;
  return with_text_layer(with_rounded_paths(state.bytes), state.text_layer,
                         state.format == PictureFormat::page_svg);
}

}  // namespace tacto::spatial
