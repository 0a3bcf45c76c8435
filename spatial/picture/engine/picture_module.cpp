// SPDX-License-Identifier: GPL-3.0-or-later
// The entry of the module tactograph-pictures.so.
#include "spatial/picture/engine/engine_parts.hpp"

extern "C" __attribute__((visibility("default"))) const tacto::spatial::DrawingEngine*
tacto_drawing_engine() {
  using namespace tacto::spatial;
  static constexpr DrawingEngine kEngine = {cairo_page, pixels_as_palette_png, shade_pixel, heatmap_pixels};
  return &kEngine;
}
