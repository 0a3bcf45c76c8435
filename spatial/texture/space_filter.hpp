// SPDX-License-Identifier: GPL-3.0-or-later
// The band-pass of a texture along position, in addition to that of its recording in time.
#pragma once

#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::spatial {

/// A band in time becomes a band along the surface that changes with the finger's speed (k = f / v); this one
/// is constant. Kernels and errors are those of fourier_filter and filter_zero_phase, in cycles per metre.
struct SpaceFilter {
  FilterMethod method = FilterMethod::fourier;
  double low_per_m = 0, high_per_m = 0;
  Edges edges = Edges::treated;
  int order = 4;  ///< of the Butterworth filter, before it is run forwards and backwards

  /// The part of the band that keeps nine tenths of its amplitude, in 1/m: the whole band except with
  /// FilterMethod::butterworth.
  schema::KnownBand kept(double pitch_m) const;
};

/// Filters values that are `pitch_m` apart; the result has their number and unit. Errors: unsuitable, for a
/// band that does not increase or exceeds half a cycle per sample, for less than one period of the lowest
/// frequency, and for a value that is not a finite number; of the Butterworth design.
schema::Result<std::vector<double>> filter_in_space(std::span<const double> values, double pitch_m,
                                                    const SpaceFilter& filter);

}  // namespace tacto::spatial
