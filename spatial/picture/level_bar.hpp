// SPDX-License-Identifier: GPL-3.0-or-later
// The key to a spectrogram's colours.
#pragma once

#include <string>

#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/heatmap.hpp"

namespace tacto::spatial {

/// A bar from the darkest colour at its bottom to the brightest, with an axis of levels at its right.
void draw_level_bar(Canvas& canvas, const Box& bar, const LevelRange& levels, const std::string& caption);

}  // namespace tacto::spatial
