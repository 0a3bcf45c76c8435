// SPDX-License-Identifier: GPL-3.0-or-later
// Which levels a texture needs, and how densely they are sampled.
#pragma once

#include "playback/prepare/prepare.hpp"
#include "playback/prepare/pyramid.hpp"

namespace tacto::playback {

/// Of the finest content, as options say or as usual for their interpolation: 16 for hermite, 6 for sinc, 64
/// for linear and nearest.
double samples_per_period(const PrepareOptions& options);

/// Levels from what the texture holds (highest_per_m, highest_spatial_frequency() of it) down to what passes
/// at the greatest speed (passes_to_hz / max_speed_mps), at most kMaxLevels.
PyramidShape pyramid_shape(double highest_per_m, double passes_to_hz, const PrepareOptions& options);

}  // namespace tacto::playback
