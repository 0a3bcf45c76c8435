// SPDX-License-Identifier: GPL-3.0-or-later
// How fine a texture is: what decides how densely it must be read at speed.
#pragma once

#include "data-schema/base/signal.hpp"

namespace tacto::playback {

/// The spatial frequency in 1/m above which less than 1e-10 (-100 dB) of the texture's energy lies, its mean
/// left out and its ends under a Hann window. At most half the grid's; 0 for a constant.
double highest_spatial_frequency(const schema::SpaceSignal& texture);

/// RMS of the texture's slope re its own, rad/m, of what lies from low to high (1/m), windowed alike: what a
/// place that is off by 1 m would cost. 0 where nothing lies there.
double relative_slope(const schema::SpaceSignal& texture, double low_per_m, double high_per_m);

}  // namespace tacto::playback
