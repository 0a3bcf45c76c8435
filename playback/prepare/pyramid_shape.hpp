// SPDX-License-Identifier: GPL-3.0-or-later
// Which levels a texture needs, and their sample density.
#pragma once

#include "playback/prepare/prepare.hpp"
#include "playback/prepare/pyramid.hpp"

namespace tacto::playback {

/// For the finest content; the option, or the interpolation's default: 16 for hermite, 6 for sinc, 64 for
/// linear and nearest.
double samples_per_period(const PrepareOptions& options);

/// Levels from the texture's highest frequency (highest_per_m, its highest_spatial_frequency()) down to the
/// one that passes at the greatest speed (passes_to_hz / max_speed_mps), at most kMaxLevels.
PyramidShape pyramid_shape(double highest_per_m, double passes_to_hz, const PrepareOptions& options);

}  // namespace tacto::playback
