// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/engine/engine_parts.hpp"

#include <cairo-svg.h>
#include <cairo.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <string>
#include <string_view>

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

Surface make_surface(bool png, Size page, std::string& bytes) {
  if (png)
    return Surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(page.width), pixels(page.height)));
  return Surface(cairo_svg_surface_create_for_stream(append, &bytes, page.width, page.height));
}

// No hinting, because it moves letters by fractions of a pixel, and differently in PNG and SVG.
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

// Attaches a PNG for an SVG to embed, instead of the one with three channels that Cairo makes.
void attach_png(cairo_surface_t* surface, std::string png) {
  if (png.empty()) return;
  auto bytes = std::make_unique<std::string>(std::move(png));
  const auto* data = reinterpret_cast<const unsigned char*>(bytes->data());
  const auto attached = cairo_surface_set_mime_data(surface, CAIRO_MIME_TYPE_PNG, data, bytes->size(),
                                                    release_bytes, bytes.get());
  if (attached == CAIRO_STATUS_SUCCESS) static_cast<void>(bytes.release());
}

// Cairo numbers the surfaces of the whole process ("image6"). Numbered within the picture instead, an SVG
// does not depend on what was drawn before it.
std::string numbered_within(const std::string& svg) {
  std::map<std::string_view, std::size_t> numbers;
  std::string numbered;
  std::size_t copied = 0;
  for (std::size_t quote = svg.find('"'); quote != std::string::npos; quote = svg.find('"', quote + 1)) {
    const std::size_t begin = quote + 1 + (svg.compare(quote + 1, 1, "#") == 0 ? 1 : 0);
    const std::string_view name = std::string_view(svg).substr(begin, svg.find('"', begin) - begin);
    const std::size_t digits = name.starts_with("image") ? 5 : name.starts_with("surface") ? 7 : name.size();
    if (digits >= name.size() || name.find_first_not_of("0123456789", digits) != std::string_view::npos)
      continue;
    const std::size_t number = numbers.try_emplace(name.substr(digits), numbers.size()).first->second;
    numbered.append(svg, copied, begin + digits - copied).append(std::to_string(number));
    copied = begin + name.size();
  }
  return numbered.append(svg, copied);
}

class CairoPage : public Page {
 public:
  CairoPage(bool png, Size size) : png_(png), surface_(make_surface(png, size, bytes_)) {
    cairo_.reset(cairo_create(surface_.get()));
    if (png) cairo_scale(cairo_.get(), kPixelsPerPoint, kPixelsPerPoint);
    cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
    layout_.reset(pango_cairo_create_layout(cairo_.get()));
    PangoContext* const context = pango_layout_get_context(layout_.get());
    pango_cairo_context_set_font_options(context, unhinted().get());
    pango_cairo_context_set_resolution(context, 72);
    pango_context_set_round_glyph_positions(context, FALSE);
  }

  void fill(const Box& box, const Colour& colour) override {
    ink(colour);
    cairo_rectangle(cairo_.get(), box.x, box.y, box.width, box.height);
    cairo_fill(cairo_.get());
  }

  void frame(const Box& box, const Pen& pen) override {
    cairo_rectangle(cairo_.get(), box.x, box.y, box.width, box.height);
    stroke(pen);
  }

  void lines(std::span<const Segment> lines, const Pen& pen) override {
    cairo_new_path(cairo_.get());
    for (const Segment& line : lines) {
      cairo_move_to(cairo_.get(), line.from.x, line.from.y);
      cairo_line_to(cairo_.get(), line.to.x, line.to.y);
    }
    stroke(pen);
  }

  void polyline(std::span<const Point> points, const Pen& pen) override {
    path(points);
    stroke(pen);
  }

  void polygon(std::span<const Point> points, const Colour& colour) override {
    path(points);
    ink(colour);
    cairo_fill(cairo_.get());
  }

  void image(const Box& box, const Pixels& pixels, std::string png) override {
    cairo_t* cairo = cairo_.get();
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels.width, pixels.height));
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return;
    unsigned char* rows = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
    const auto width = static_cast<std::size_t>(pixels.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(pixels.height); ++y)
      std::memcpy(rows + y * stride, pixels.rgb.data() + y * width, width * sizeof(std::uint32_t));
    cairo_surface_mark_dirty(surface.get());
    attach_png(surface.get(), std::move(png));
    cairo_save(cairo);
    cairo_translate(cairo, box.x, box.y);
    cairo_scale(cairo, box.width / pixels.width, box.height / pixels.height);
    cairo_set_source_surface(cairo, surface.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
    cairo_rectangle(cairo, 0, 0, pixels.width, pixels.height);
    cairo_fill(cairo);
    cairo_restore(cairo);
  }

  Size text_size(const std::string& text, const TextStyle& style) override {
    const Font font(pango_font_description_from_string("DejaVu Sans"));
    pango_font_description_set_size(font.get(), static_cast<int>(std::lround(style.size * PANGO_SCALE)));
    pango_font_description_set_weight(font.get(), style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_layout_set_font_description(layout_.get(), font.get());
    pango_layout_set_text(layout_.get(), text.c_str(), static_cast<int>(text.size()));
    int width = 0;
    int height = 0;
    pango_layout_get_size(layout_.get(), &width, &height);
    return {pango_units_to_double(width), pango_units_to_double(height)};
  }

  TextExtent text(Point at, const std::string& text, const TextStyle& style, bool drawn) override {
    const Size size = text_size(text, style);
    if (drawn) show({-style.align_x * size.width, -style.align_y * size.height}, at, style);
    return {size, pango_units_to_double(pango_layout_get_baseline(layout_.get()))};
  }

  void clip(const Box& box) override {
    cairo_save(cairo_.get());
    cairo_rectangle(cairo_.get(), box.x, box.y, box.width, box.height);
    cairo_clip(cairo_.get());
  }

  void clip(std::span<const Point> polygon) override {
    cairo_save(cairo_.get());
    path(polygon);
    cairo_clip(cairo_.get());
  }

  void release() override { cairo_restore(cairo_.get()); }

  schema::Result<std::string> encode() override {
    if (png_) cairo_surface_write_to_png_stream(surface_.get(), append, &bytes_);
    cairo_surface_finish(surface_.get());
    for (const cairo_status_t status : {cairo_status(cairo_.get()), cairo_surface_status(surface_.get())})
      if (status != CAIRO_STATUS_SUCCESS && status != CAIRO_STATUS_SURFACE_FINISHED)
        return schema::fail(schema::ErrorKind::internal, cairo_status_to_string(status), "picture");
    return png_ ? bytes_ : numbered_within(bytes_);
  }

 private:
  void ink(const Colour& colour) {
    cairo_set_source_rgba(cairo_.get(), colour.red, colour.green, colour.blue, colour.alpha);
  }

  void stroke(const Pen& pen) {
    constexpr double kDash[] = {4, 2.5};
    ink(pen.colour);
    cairo_set_line_width(cairo_.get(), pen.width);
    cairo_set_dash(cairo_.get(), kDash, pen.dashed ? 2 : 0, 0);
    cairo_stroke(cairo_.get());
  }

  void path(std::span<const Point> points) {
    cairo_new_path(cairo_.get());
    for (const Point& point : points) cairo_line_to(cairo_.get(), point.x, point.y);
  }

  // The layout of a text.
  void show(Point corner, Point at, const TextStyle& style) {
    cairo_save(cairo_.get());
    cairo_translate(cairo_.get(), at.x, at.y);
    if (style.upward) cairo_rotate(cairo_.get(), -std::numbers::pi / 2);
    cairo_move_to(cairo_.get(), corner.x, corner.y);
    ink(style.colour);
    pango_cairo_show_layout(cairo_.get(), layout_.get());
    cairo_restore(cairo_.get());
  }

  bool png_;
  std::string bytes_;  // before the surface, which writes to it until it is destroyed
  Surface surface_;
  Cairo cairo_;
  Layout layout_;
};

}  // namespace

std::unique_ptr<Page> cairo_page(bool png, Size size) {
  return std::make_unique<CairoPage>(png, size);
}

}  // namespace tacto::spatial
