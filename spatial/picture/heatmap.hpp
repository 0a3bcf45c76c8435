// SPDX-License-Identifier: GPL-3.0-or-later
// A spectrogram as coloured pixels on a logarithmic frequency axis: the door to OpenCV.
#pragma once

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/picture/draw/geometry.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {

/// Levels from the darkest to the brightest colour, in dB over the reference.
struct LevelRange {
  double low_db = -60, high_db = 0;
};

/// Viridis: even to the eye, and readable in grey and by colour-blind people.
Colour level_colour(double level_db, const LevelRange& levels);
std::uint32_t level_pixel(double level_db, const LevelRange& levels);

/// The whole spectrogram, `size` pixels: columns are positions at even distance from half a hop before the
/// first to half a hop after the last, rows fall from high_per_m to low_per_m evenly in the logarithm. Power
/// is averaged where several cells fall in a pixel, and interpolated where a cell is larger than one.
/// Preconditions: 0 < low_per_m < high_per_m, size at least 1 x 1. Errors: internal, by OpenCV's words.
schema::Result<Pixels> heatmap(const schema::Spectrogram& spectrogram, double low_per_m, double high_per_m,
                               const LevelRange& levels, int width, int height);

}  // namespace tacto::spatial
