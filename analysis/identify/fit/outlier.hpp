// SPDX-License-Identifier: GPL-3.0-or-later
// Finds one value that does not belong to its response: a wrong digit, a range switched in the middle.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

/// The residuals of a fit: the sum of the whitened residuals' squares, and whether they look like noise.
struct RestOfFit {
  double left = 0;
  bool is_noise = false;
  bool is_even = false;  ///< the same size over the whole band
};
struct Outlier {
  std::size_t index = 0;  ///< of the frequencies, from 0
  double left = 1;        ///< ratio of the residuals' squares without it to those with it
  RestOfFit rest;         ///< of that fit
};

BodeData without_value(const BodeData& data, std::size_t index);

using LeftByFit = std::function<RestOfFit(const BodeData&)>;

/// The value without which a fit's sum of squares is less than a tenth of that of all values. Fits are made
/// without each of the values farthest from the median of five neighbours, and without each of the largest
/// residuals by `shares`. From 16 values on, noise alone causes this in fewer than 1 of 10,000. If the noise
/// is estimated from the residuals, also a value that removes more than Gaussian noise does once in 1e9
/// tables (F test, two values of 2 n - p), if the rest is noise. Precondition: as many shares as values.
std::optional<Outlier> outlier_of(const BodeData& data, std::span<const double> shares, double left_by_all,
                                  const LeftByFit& left_by_fit);

}  // namespace tacto::analysis
