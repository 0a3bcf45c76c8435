// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/engine/engine_parts.hpp"

#include <png.h>

#include <cstring>
#include <unordered_map>
#include <vector>

namespace tacto::spatial {
namespace {

constexpr std::size_t kMostColours = 256;

struct Indexed {
  std::vector<std::uint8_t> pixels;
  std::vector<std::uint8_t> palette;  // red, green, blue
  std::size_t colours() const { return palette.size() / 3; }
};

// Without pixels if there are too many colours.
Indexed indexed(const Pixels& pixels) {
  Indexed result;
  std::unordered_map<std::uint32_t, std::uint8_t> index;
  for (const std::uint32_t rgb : pixels.rgb) {
    const auto [at, is_new] = index.try_emplace(rgb, static_cast<std::uint8_t>(index.size()));
    if (is_new && index.size() > kMostColours) return {};
    if (is_new)
      for (const int shift : {16, 8, 0})
        result.palette.push_back(static_cast<std::uint8_t>(rgb >> shift & 0xFF));
    result.pixels.push_back(at->second);
  }
  return result;
}

}  // namespace

std::string pixels_as_palette_png(const Pixels& pixels) {
  const Indexed image = indexed(pixels);
  if (image.pixels.empty()) return {};
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(pixels.width);
  header.height = static_cast<png_uint_32>(pixels.height);
  header.format = PNG_FORMAT_RGB_COLORMAP;
  header.colormap_entries = static_cast<png_uint_32>(image.colours());
  png_alloc_size_t size = 0;
  const auto write = [&](void* memory) {
    return png_image_write_to_memory(&header, memory, &size, 0, image.pixels.data(), 0,
                                     image.palette.data()) != 0;
  };
  if (!write(nullptr)) return {};
  std::string bytes(size, '\0');
  if (!write(bytes.data())) return {};
  bytes.resize(size);
  return bytes;
}

}  // namespace tacto::spatial
