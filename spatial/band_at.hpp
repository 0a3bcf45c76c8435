// SPDX-License-Identifier: GPL-3.0-or-later
// The band that a texture knows at one place, and along a stretch.
#pragma once

#include <span>

#include "data-schema/texture.hpp"

namespace tacto::spatial {

/// The band at a position, straight between its breakpoints and level beyond them. Precondition: a
/// breakpoint.
schema::BandPoint band_at(std::span<const schema::BandPoint> band, double position_m);

/// What is valid all along a stretch; low_per_m >= high_per_m where nothing is. Precondition: a breakpoint.
schema::BandPoint band_along(std::span<const schema::BandPoint> band, double from_m, double to_m);

}  // namespace tacto::spatial
