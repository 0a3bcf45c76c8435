// SPDX-License-Identifier: GPL-3.0-or-later
// The band-pass of a texture along position, beside the one of its recording in time.
#pragma once

#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::spatial {

/// A band in time becomes, along the surface, a band that moves with the finger's speed (k = f / v); this one
/// stays where it is. The same kernels and the same errors, in cycles per metre: see fourier_filter and
/// filter_zero_phase.
struct SpaceFilter {
  FilterMethod method = FilterMethod::fourier;
  double low_per_m = 0, high_per_m = 0;
  Edges edges = Edges::treated;
  int order = 4;  ///< of the Butterworth filter, before it is run both ways

  /// The part of the band that keeps nine tenths of its amplitude, in 1/m: all of it but with
  /// FilterMethod::butterworth.
  schema::KnownBand kept(double pitch_m) const;
};

/// Values `pitch_m` apart, filtered; as many as there were, in their unit. Errors: unsuitable, for a band
/// that doesn't rise or reaches over half a cycle a sample, for less than one period of the lowest frequency,
/// and for a value that is not a finite number; of the Butterworth design.
schema::Result<std::vector<double>> filter_in_space(std::span<const double> values, double pitch_m,
                                                    const SpaceFilter& filter);

}  // namespace tacto::spatial
