// SPDX-License-Identifier: GPL-3.0-or-later
// The band-pass of a recording in time, by one of the known methods.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/filter/fourier_filter.hpp"

namespace tacto::spatial {

enum class FilterMethod {
  fourier,      ///< truncation of the Fourier transform, as in Wiertlewski 2011
  butterworth,  ///< forwards and backwards through second-order sections
  none,         ///< everything passes
};

struct TimeFilter {
  FilterMethod method = FilterMethod::fourier;
  Band band;
  Edges edges = Edges::treated;
  int order = 4;  ///< of the Butterworth filter, before it is run both ways

  /// The band that passes; with FilterMethod::none all up to half the rate.
  Band passed(double sample_rate_hz) const;
  /// What of it keeps nine tenths of its amplitude: all of it but with FilterMethod::butterworth.
  Band kept(double sample_rate_hz) const;
};

/// The amplitude that a Butterworth filter keeps at least, forwards and backwards, where its band is called
/// valid.
inline constexpr double kKeptAmplitude = 0.9;

/// "fourier", "butterworth", "none"; "treated", "none".
std::string_view name_of(FilterMethod method);
std::string_view name_of(Edges edges);

/// Errors: unsuitable, for a band that doesn't rise or reaches over half the rate; of the Butterworth design.
schema::Result<void> check(const TimeFilter& filter, double sample_rate_hz);

/// Filters a stretch without gaps, and equalises it where there is an equaliser (inside the band; in one
/// transform with FilterMethod::fourier). As many values as there were, in their unit. Errors: of check();
/// unsuitable, for a value that is not a finite number, by its index.
schema::Result<std::vector<double>> filter_in_time(std::span<const double> values, double sample_rate_hz,
                                                   const TimeFilter& filter,
                                                   const SpectralGain& equaliser = {});

}  // namespace tacto::spatial
