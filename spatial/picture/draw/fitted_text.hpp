// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that are fitted to a width.
#pragma once

#include <string>
#include <vector>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// Draws the text on one line, in smaller letters if it is too wide. If they would be smaller than 5 points,
/// the text is cut with an ellipsis.
void draw_fitted(Canvas& canvas, Point at, std::string text, TextStyle style, double width);

/// The whole text in lines that fit, broken at spaces; a word that is wider than a line is broken inside. An
/// empty text has no line.
std::vector<std::string> wrapped(Canvas& canvas, const std::string& text, const TextStyle& style,
                                 double width);

}  // namespace tacto::spatial
