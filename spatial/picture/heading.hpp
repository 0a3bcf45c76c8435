// SPDX-License-Identifier: GPL-3.0-or-later
// The head of a figure: title, the facts under it, and the badge that tells simulated data from measured.
#pragma once

#include <string>

#include "spatial/picture/canvas.hpp"

namespace tacto::spatial {

/// Height that draw_heading takes, in points.
inline constexpr double kHeadingHeight = 42;

/// Title and subtitle at the box's top left; where `simulated` says by what, "SIMULATED" at its top right.
/// Texts that are too long are cut with an ellipsis.
void draw_heading(Canvas& canvas, const Box& box, const std::string& title, const std::string& subtitle,
                  const std::string& simulated);

}  // namespace tacto::spatial
