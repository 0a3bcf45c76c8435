// SPDX-License-Identifier: GPL-3.0-or-later
// Improved noise in double precision: the reference of core::noise().
#pragma once

#include "firmware-host/core/scene/noise.hpp"

namespace tacto::playback {

/// Perlin's program of 2002, statement by statement, with a table of gradients' order. Lattice units.
double exact_noise(const core::NoiseTable& table, double x, double y, double z);

}  // namespace tacto::playback
