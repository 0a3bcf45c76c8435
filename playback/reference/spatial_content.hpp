// SPDX-License-Identifier: GPL-3.0-or-later
// How fine a texture is: what decides how densely it must be read at speed.
#pragma once

#include "data-schema/signal.hpp"

namespace tacto::playback {

/// The spatial frequency in 1/m above which less than 1e-10 (-100 dB) of the texture's energy lies, its mean
/// left out and its ends under a Hann window. At most half the grid's; 0 for a constant.
double highest_spatial_frequency(const schema::SpaceSignal& texture);

}  // namespace tacto::playback
