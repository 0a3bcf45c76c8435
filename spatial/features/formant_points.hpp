// SPDX-License-Identifier: GPL-3.0-or-later
// The peaks of one row of a spectrogram that exceed its background.
#pragma once

#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/spectrogram/known_bins.hpp"
#include "spatial/spectrogram/spectrogram_background.hpp"

namespace tacto::spatial {

struct RidgePoint {
  std::size_t row = 0;
  double frequency_per_m = 0;
  double density = 0;        ///< unit^2 m
  double prominence_db = 0;  ///< over the background
  double width_per_m = 0;    ///< between its half-power points
};

/// Sorted by frequency. A parabola through the levels of three bins gives the position of the maximum.
std::vector<RidgePoint> ridge_points(const schema::Spectrogram& spectrogram, std::size_t row, BinRange known,
                                     const SpectrogramBackground& background, double least_prominence_db);

}  // namespace tacto::spatial
