// SPDX-License-Identifier: GPL-3.0-or-later
// The layer of text in an SVG. Cairo writes letters as outlines only; this keeps the words beside them.
#pragma once

#include <string>
#include <string_view>

#include "spatial/picture/canvas.hpp"

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

/// The SVG with the elements in a transparent group before its end.
std::string with_text_layer(std::string svg, std::string_view elements);

}  // namespace tacto::spatial
