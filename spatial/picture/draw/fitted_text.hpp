// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that have to fit.
#pragma once

#include <string>
#include <vector>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// Draws the text on one line, in smaller letters where it is wider; cut with an ellipsis only where they
/// would be smaller than 5 points.
void draw_fitted(Canvas& canvas, Point at, std::string text, TextStyle style, double width);

/// The whole text in lines that fit, broken at spaces; a word that is wider than a line is broken within. No
/// line for an empty text.
std::vector<std::string> wrapped(Canvas& canvas, const std::string& text, const TextStyle& style,
                                 double width);

}  // namespace tacto::spatial
