// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that have to fit.
#pragma once

#include <string>

#include "spatial/picture/canvas.hpp"

namespace tacto::spatial {

/// The text, cut with an ellipsis where it is wider.
std::string fitted(Canvas& canvas, std::string text, const TextStyle& style, double width);

}  // namespace tacto::spatial
