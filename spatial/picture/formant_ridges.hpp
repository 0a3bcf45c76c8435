// SPDX-License-Identifier: GPL-3.0-or-later
// Draws formants over a spectrogram: thin outlined ridges with their frequencies.
#pragma once

#include <span>

#include "data-schema/texture/formants.hpp"
#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/canvas.hpp"

namespace tacto::spatial {

/// Within `area`, a part of the spectrogram's box; axes in mm and 1/mm. The strongest `labels` of them have
/// their mean frequency as a label, if there is space. Formants are drawn in the given order.
void draw_formants(Canvas& canvas, const Box& area, std::span<const schema::Formant> formants,
                   const Axis& position, const Axis& frequency, std::size_t labels);

/// One ridge through points of the page, in the same style: for the legend.
void draw_ridge(Canvas& canvas, std::span<const Point> points);

}  // namespace tacto::spatial
