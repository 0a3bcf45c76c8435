// SPDX-License-Identifier: GPL-3.0-or-later
// A spectrogram as coloured pixels on a logarithmic frequency axis; the interface to OpenCV.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/draw/geometry.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {

/// Levels of the darkest and the brightest colour, in dB re the reference.
struct LevelRange {
  double low_db = -60, high_db = 0;
};

/// Viridis: perceptually uniform, and readable in grey and by colour-blind people.
Colour level_colour(double level_db, const LevelRange& levels);
std::uint32_t level_pixel(double level_db, const LevelRange& levels);

/// The whole spectrogram, `size` pixels: columns are equidistant positions from half a hop before the first
/// to half a hop after the last, rows are equidistant in the logarithm from high_per_m down to low_per_m.
/// Power is averaged if several cells share a pixel, and interpolated if a cell is larger than one.
/// Preconditions: 0 < low_per_m < high_per_m, size at least 1 x 1. Errors: internal, with OpenCV's message.
schema::Result<Pixels> heatmap(const schema::Spectrogram& spectrogram, double low_per_m, double high_per_m,
                               const LevelRange& levels, int width, int height);

/// A bar from the darkest colour at the bottom to the brightest, with an axis of levels on the right.
void draw_level_bar(Canvas& canvas, const Box& bar, const LevelRange& levels, const std::string& caption);

}  // namespace tacto::spatial
