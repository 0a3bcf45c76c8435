// SPDX-License-Identifier: GPL-3.0-or-later
// The colour bar of a spectrogram.
#pragma once

#include <string>

#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/heatmap.hpp"

namespace tacto::spatial {

/// A bar from the darkest colour at the bottom to the brightest, with an axis of levels on the right.
void draw_level_bar(Canvas& canvas, const Box& bar, const LevelRange& levels, const std::string& caption);

}  // namespace tacto::spatial
