// SPDX-License-Identifier: GPL-3.0-or-later
// The valid band of a texture at one position.
#pragma once

#include <span>

#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// The band at a position, linear between its breakpoints and constant beyond them. Precondition: at least
/// one breakpoint.
schema::BandPoint band_at(std::span<const schema::BandPoint> band, double position_m);

}  // namespace tacto::spatial
