// SPDX-License-Identifier: GPL-3.0-or-later
// Draws axes at the sides of a box: ticks, their labels, a caption, grid lines.
#pragma once

#include <string>
#include <vector>

#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

enum class Side { left, right, bottom };

inline constexpr double kTickLabelSize = 10;
inline constexpr double kCaptionSize = 11;

/// Draws ticks outside the box with their labels; the caption is `caption_gap` points from the box.
void draw_axis(Canvas& canvas, const Box& box, Side side, const Axis& axis, const std::vector<Tick>& ticks);
void draw_caption(Canvas& canvas, const Box& box, Side side, const std::string& caption, double gap);

/// Thin lines across the box at the labelled ticks.
void draw_grid(Canvas& canvas, const Box& box, bool across, const Axis& axis, const std::vector<Tick>& ticks);

}  // namespace tacto::spatial
