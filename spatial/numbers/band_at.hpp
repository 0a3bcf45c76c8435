// SPDX-License-Identifier: GPL-3.0-or-later
// The band that a texture knows at one place.
#pragma once

#include <span>

#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// The band at a position, straight between its breakpoints and level beyond them. Precondition: a
/// breakpoint.
schema::BandPoint band_at(std::span<const schema::BandPoint> band, double position_m);

}  // namespace tacto::spatial
