// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/svg_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tacto::spatial {
namespace {

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

}  // namespace

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

std::string with_text_layer(std::string svg, std::string_view elements, bool visible) {
  const auto end = svg.rfind("</svg>");
  if (end == std::string::npos) return svg;
  svg.insert(end, fmt::format("{}<g{} font-family=\"'DejaVu Sans', Verdana, sans-serif\">\n{}</g>\n",
                              visible ? kDark : "", visible ? "" : " fill-opacity=\"0\"", elements));
  return svg;
}

}  // namespace tacto::spatial
