// SPDX-License-Identifier: GPL-3.0-or-later
// How a piece that slides moves in a tick, and how stiff its wall may be.
#pragma once

#include <string>

#include "data-schema/scene/scene.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::playback {

/// The stiffness of a wall below which the motion of its piece is stable in ticks of T with a hand at rest,
/// without friction: (K + k) T^2 / m + 2 B T / m < 4, with k of the detents and the damper B of the wall;
/// infinity for a piece that does not slide.
double stiffest_slide_n_per_m(const schema::Piece& piece, double tick_s);

/// Precondition: the piece slides. Errors: unsuitable, by JSON pointer (`where` is that of the piece): a wall
/// that is too stiff for mass and rate, at the worse ends of its sliders, with the stiffest that fits.
schema::Result<core::SlideTable> slide_table(const schema::Piece& piece, double tick_s,
                                             const std::string& where);

}  // namespace tacto::playback
