// SPDX-License-Identifier: GPL-3.0-or-later
// What a filter sees beyond the ends of a record, so that it does not ring from them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// treated: the record goes on beyond its ends. none: the Fourier transform joins its last sample to its
/// first.
enum class Edges { treated, none };

/// How long the record goes on, and over how much of each end its baseline is fitted.
struct EndTreatment {
  std::size_t padding = 0;   ///< samples beyond each end, at most size - 1
  std::size_t baseline = 2;  ///< samples, 2 ... size

  /// 8 periods of the lowest frequency of padding, a baseline over 2; a record that is shorter gives what it
  /// has.
  static EndTreatment for_lowest(double low_hz, double sample_rate_hz, std::size_t size);
};

/// The record in the middle of `length` >= size + 2 padding samples, sample 0 at index `padding`. Beyond each
/// end the straight baseline of that end goes on and what the record has above it is mirrored, both tapered
/// smoothly to one level that both ends share: no jump, no kink of the drift, and periodic. At least 2
/// values.
std::vector<double> extend_ends(std::span<const double> values, EndTreatment treatment, std::size_t length);

/// Point-mirrored about its first and last sample, `padding` < size samples at each end, as
/// scipy.signal.sosfiltfilt does (padtype "odd").
std::vector<double> extend_odd(std::span<const double> values, std::size_t padding);

}  // namespace tacto::spatial
