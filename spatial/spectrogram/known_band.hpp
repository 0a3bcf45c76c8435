// SPDX-License-Identifier: GPL-3.0-or-later
// The known cells of a spectrogram, from the valid band of its texture.
#pragma once

#include <span>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// The middle part of a Blackman window that has 90 % of its power, relative to its length (integral of w^2;
/// 0.39178).
inline constexpr double kKnownPart = 0.392;

/// The band that is valid in all of [from_m, to_m]: the highest of the low limits and the lowest of the high
/// ones. k = f / v is linear between breakpoints and constant beyond them. low_per_m > high_per_m if there is
/// no such band. Precondition: `band` is not empty and its positions increase.
schema::KnownBand band_along(std::span<const schema::BandPoint> band, double from_m, double to_m);

/// For each window's centre the band that is valid in the whole middle part of the window (kKnownPart). The
/// unknown parts of the window then have at most a tenth of its power, so known cells are measured to within
/// 0.5 dB of power. If the whole window were required, the ends of a stroke would be unknown because of
/// samples that the window almost excludes. Empty if `band` is.
std::vector<schema::KnownBand> known_bands(std::span<const schema::BandPoint> band,
                                           std::span<const double> centre_m, double window_m);

}  // namespace tacto::spatial
