// SPDX-License-Identifier: GPL-3.0-or-later
// Decodes a PNG in memory to pixels, for tests of pictures.
#pragma once

#include <cairo.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace tacto::spatial::samples {

struct DecodedPng {
  int width = 0, height = 0;
  std::vector<std::uint32_t> rgb;
  std::uint32_t at(int x, int y) const { return rgb[static_cast<std::size_t>(y * width + x)] & 0xFFFFFFU; }
};

inline cairo_status_t take_bytes(void* rest, unsigned char* out, unsigned int length) {
  auto& text = *static_cast<std::string_view*>(rest);
  if (text.size() < length) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(out, text.data(), length);
  text.remove_prefix(length);
  return CAIRO_STATUS_SUCCESS;
}

/// An empty picture if the bytes are not a PNG.
inline DecodedPng decode_png(const std::string& bytes) {
  std::string_view rest = bytes;
  cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(take_bytes, &rest);
  DecodedPng png;
  if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
    png.width = cairo_image_surface_get_width(surface);
    png.height = cairo_image_surface_get_height(surface);
    const unsigned char* data = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    png.rgb.resize(static_cast<std::size_t>(png.width) * static_cast<std::size_t>(png.height));
    for (int y = 0; y < png.height; ++y)
      std::memcpy(png.rgb.data() + y * png.width, data + y * stride, static_cast<std::size_t>(png.width) * 4);
  }
  cairo_surface_destroy(surface);
  return png;
}

}  // namespace tacto::spatial::samples
