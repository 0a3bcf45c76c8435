// SPDX-License-Identifier: GPL-3.0-or-later
// Hatching: what a picture does not know, so that it cannot be taken for a measured shade.
#pragma once

#include <span>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// Veils the polygon and hatches it with thin slanting lines; they are in register all over the page.
void draw_hatch(Canvas& canvas, std::span<const Point> polygon);

/// A sample of it, for a legend.
void draw_hatch(Canvas& canvas, const Box& box);

}  // namespace tacto::spatial
