// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/fitted_text.hpp"

#include <algorithm>

namespace tacto::spatial {
namespace {

bool begins_letter(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
}

// Length in bytes of the longest start of `text` that fits: up to a space if there is one, otherwise whole
// letters, at least one.
std::size_t bytes_that_fit(Canvas& canvas, const std::string& text, const TextStyle& style, double width) {
  if (canvas.text_size(text, style).width <= width) return text.size();
  std::size_t at_space = 0, at_letter = 0;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (!begins_letter(text[i])) continue;
    if (at_letter > 0 && canvas.text_size(text.substr(0, i), style).width > width) break;
    at_letter = i;
    if (text[i] == ' ') at_space = i;
  }
  return at_space > 0 ? at_space : at_letter > 0 ? at_letter : text.size();
}

}  // namespace

std::vector<std::string> wrapped(Canvas& canvas, const std::string& text, const TextStyle& style,
                                 double width) {
  std::vector<std::string> lines;
  for (std::string rest = text; !rest.empty();) {
    const std::size_t bytes = bytes_that_fit(canvas, rest, style, width);
    lines.push_back(rest.substr(0, bytes));
    rest.erase(0, std::min(rest.size(), bytes + (bytes < rest.size() && rest[bytes] == ' ' ? 1 : 0)));
  }
  return lines;
}

void draw_fitted(Canvas& canvas, Point at, std::string text, TextStyle style, double width) {
  constexpr double kSmallest = 5;
  const double wide = canvas.text_size(text, style).width;
  if (wide > width) style.size = std::max(kSmallest, style.size * width / wide);
  // Removes whole UTF-8 letters until the text and its ellipsis fit.
  bool cut = false;
  while (text.size() > 1 && canvas.text_size(text + (cut ? "\u2026" : ""), style).width > 1.001 * width) {
    while (!begins_letter(text.back())) text.pop_back();
    text.pop_back();
    cut = true;
  }
  canvas.text(at, text + (cut ? "\u2026" : ""), style);
}

}  // namespace tacto::spatial
