// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

using schema::ErrorKind;
using schema::Result;

namespace {

// The size limit of Cairo's image surfaces.
constexpr double kMostPixels = 32767;

Result<std::string> encoded(const Figure& figure, PictureFormat format) {
  const Size page = figure.page();
  if (std::max(page.width, page.height) * kPixelsPerPoint > kMostPixels)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("a page with a height of {:g} points is too large", page.height),
                        "picture", "draw fewer things on one page");
  Canvas canvas(format, page);
  TACTO_TRY(figure.draw(canvas));
  return canvas.encode();
}

bool ends_in(const std::string& path, std::string_view extension) {
  if (path.size() < extension.size()) return false;
  return std::equal(extension.rbegin(), extension.rend(), path.rbegin(),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

}  // namespace

Result<std::string> to_png(const Figure& figure) {
  return encoded(figure, PictureFormat::png);
}
Result<std::string> to_svg(const Figure& figure) {
  return encoded(figure, PictureFormat::svg);
}
Result<std::string> to_page_svg(const Figure& figure) {
  return encoded(figure, PictureFormat::page_svg);
}

Result<std::string> encode_as(const std::string& path, const Figure& figure) {
  if (ends_in(path, ".png")) return to_png(figure);
  if (ends_in(path, ".svg")) return to_svg(figure);
  return schema::fail(ErrorKind::usage, "this picture format is not supported", path, "use .png or .svg");
}

Result<void> add_figure(schema::PendingFiles& files, const std::string& path, const Figure& figure) {
  const auto bytes = encode_as(path, figure);
  TACTO_TRY(bytes);
  return files.write(path, *bytes);
}

Result<void> write_figure(const std::string& path, const Figure& figure) {
  schema::PendingFiles files;
  if (auto added = add_figure(files, path, figure); !added) return added;
  return files.commit();
}

}  // namespace tacto::spatial
