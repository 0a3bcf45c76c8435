// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells of a spectrogram the recording could know: from the band in which its texture is valid.
#pragma once

#include <span>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// The middle of a Blackman window that carries 90 % of the power it passes, as a part of its length
/// (integral of w^2; 0.39178).
inline constexpr double kKnownPart = 0.392;

/// The band that is valid all along [from_m, to_m]: the highest of the low limits and the lowest of the high
/// ones, k = f / v being straight between breakpoints and level beyond them. low_per_m > high_per_m where
/// there is none. Precondition: `band` is not empty and its positions grow.
schema::KnownBand band_along(std::span<const schema::BandPoint> band, double from_m, double to_m);

/// For each window's centre the band that is valid throughout the middle of the window (kKnownPart). Every
/// part of the window that is left unknown together weighs at most a tenth of it, so what is called known was
/// measured to within 0.5 dB of power; asking it of the whole window would call a stroke's ends unknown for
/// samples that the window all but leaves out. Empty where `band` is.
std::vector<schema::KnownBand> known_bands(std::span<const schema::BandPoint> band,
                                           std::span<const double> centre_m, double window_m);

}  // namespace tacto::spatial
