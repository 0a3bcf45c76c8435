// SPDX-License-Identifier: GPL-3.0-or-later
// The text layer of an SVG. Cairo writes letters only as outlines; the layer adds the words as text.
#pragma once

#include <string>
#include <string_view>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// A text that was drawn: `start` is the left end of its baseline, relative to `at` after rotation.
struct PlacedText {
  std::string text;
  Point at, start;
  double width = 0;
  TextStyle style;
};

/// The <text> element, in XML.
std::string svg_text(const PlacedText& placed);

/// The SVG with the elements in a group before its end: transparent, over letters that are drawn as outlines,
/// or `visible`, instead of them.
std::string with_text_layer(std::string svg, std::string_view elements, bool visible);

}  // namespace tacto::spatial
