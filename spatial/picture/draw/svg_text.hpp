// SPDX-License-Identifier: GPL-3.0-or-later
// The layer of text in an SVG. Cairo writes letters as outlines only; this keeps the words beside them.
#pragma once

#include <string>
#include <string_view>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// A text as it was drawn: `start` is its baseline's left end, seen from `at` after turning.
struct PlacedText {
  std::string text;
  Point at, start;
  double width = 0;
  TextStyle style;
};

/// The <text> element, in XML.
std::string svg_text(const PlacedText& placed);

/// The SVG with the elements in a group before its end: transparent, over letters that are drawn as outlines,
/// or `visible`, in place of them.
std::string with_text_layer(std::string svg, std::string_view elements, bool visible);

}  // namespace tacto::spatial
