// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/fitted_text.hpp"

namespace tacto::spatial {

// Cuts whole UTF-8 letters until the text and its ellipsis fit.
std::string fitted(Canvas& canvas, std::string text, const TextStyle& style, double width) {
  if (canvas.text_size(text, style).width <= width) return text;
  while (!text.empty() && canvas.text_size(text + "\u2026", style).width > width) {
    while (!text.empty() && (text.back() & 0xC0) == 0x80) text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + "\u2026";
}

}  // namespace tacto::spatial
