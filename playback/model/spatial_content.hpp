// SPDX-License-Identifier: GPL-3.0-or-later
// How fine a texture is. This determines how densely it has to be read at a given speed.
#pragma once

#include "data-schema/base/signal.hpp"

namespace tacto::playback {

/// The spatial frequency in 1/m above which there is less than 1e-10 (-100 dB) of the texture's energy,
/// without its mean and with a Hann window. At most half the grid's; 0 for a constant.
double highest_spatial_frequency(const schema::SpaceSignal& texture);

/// RMS slope of the part of the texture from low to high (1/m) over the RMS of that part, rad/m, with the
/// same window: the relative error per metre of error in place. 0 if there is nothing in that range.
double relative_slope(const schema::SpaceSignal& texture, double low_per_m, double high_per_m);

}  // namespace tacto::playback
