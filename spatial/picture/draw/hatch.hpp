// SPDX-License-Identifier: GPL-3.0-or-later
// Hatching of the parts of a picture without data, so that they do not look like a measured shade.
#pragma once

#include <span>

#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// Veils the polygon and hatches it with thin slanting lines, which are aligned over the whole page.
void draw_hatch(Canvas& canvas, std::span<const Point> polygon);

/// A sample of the hatching, for a legend.
void draw_hatch(Canvas& canvas, const Box& box);

}  // namespace tacto::spatial
