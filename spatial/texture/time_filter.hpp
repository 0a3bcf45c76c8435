// SPDX-License-Identifier: GPL-3.0-or-later
// The band-pass of a recording in time, by one of the known methods, and the division by the sensor's
// response.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "spatial/dsp/filter/band.hpp"
#include "spatial/dsp/filter/fourier_filter.hpp"

namespace tacto::spatial {

enum class FilterMethod {
  fourier,      ///< truncation of the Fourier transform, as in Wiertlewski 2011
  butterworth,  ///< forwards and backwards through second-order sections
  none,         ///< no filter
};

struct TimeFilter {
  FilterMethod method = FilterMethod::fourier;
  Band band;
  Edges edges = Edges::treated;
  int order = 4;  ///< of the Butterworth filter, before it is run forwards and backwards

  /// The pass band; with FilterMethod::none everything up to half the rate.
  Band passed(double sample_rate_hz) const;
  /// The part of it that keeps nine tenths of its amplitude: all of it except with FilterMethod::butterworth.
  Band kept(double sample_rate_hz) const;
};

/// The smallest amplitude, after forwards and backwards, at which the band of a Butterworth filter is valid.
inline constexpr double kKeptAmplitude = 0.9;

/// "fourier", "butterworth", "none"; "treated", "none".
std::string_view name_of(FilterMethod method);
std::string_view name_of(Edges edges);

/// Errors: unsuitable, for a band that does not increase or exceeds half the rate; of the Butterworth design.
schema::Result<void> check(const TimeFilter& filter, double sample_rate_hz);

/// The largest gain that equalising gives, 20 dB: below 1 Hz and far above the resonance the sensor gives
/// no signal, and its noise must not become force.
inline constexpr double kMostEqualiserGain = 10;

/// 1 / (H_s(f) x nominal newtons per volt): a recording in nominal newtons, times this, is in true newtons.
/// It has the exact phase everywhere, and the exact size where it is under kMostEqualiserGain; 0 at 0 Hz,
/// where a charge sensor gives nothing. (The sensor's gain is level only from about 20 to 150 Hz; Wiertlewski
/// 2011, H_s.)
SpectralGain equaliser(const schema::Transducer& transducer);

/// Filters a section without gaps and equalises it if there is an equaliser (inside the band; in one
/// transform with FilterMethod::fourier). The result has the same number of values and unit. Errors: of
/// check(); unsuitable, for a value that is not a finite number, with its index.
schema::Result<std::vector<double>> filter_in_time(std::span<const double> values, double sample_rate_hz,
                                                   const TimeFilter& filter,
                                                   const SpectralGain& equaliser = {});

}  // namespace tacto::spatial
