// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the valid band on a spectrogram: its limits, and hatching outside.
#pragma once

#include <span>

#include "data-schema/texture/texture.hpp"
#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

inline const Pen kBandPen{{1, 1, 1, 0.9}, 0.75, true};

/// Draws on `area`, a part of the spectrogram's box. Axes in mm and 1/mm.
void draw_valid_band(Canvas& canvas, const Box& area, std::span<const schema::BandPoint> band,
                     const Axis& position, const Axis& frequency);

}  // namespace tacto::spatial
