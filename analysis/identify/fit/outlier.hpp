// SPDX-License-Identifier: GPL-3.0-or-later
// One value that is not of its response: a wrong digit, a range switched in the middle.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "analysis/identify/measure/bode_data.hpp"

namespace tacto::analysis {

struct Outlier {
  std::size_t index = 0;  ///< of the frequencies, from 0
  double left = 1;        ///< of the residuals' squares, where the fit is made without it
};

/// What a fit leaves of data, as the sum of the whitened residuals' squares, and whether that looks like
/// noise.
struct RestOfFit {
  double left = 0;
  bool is_noise = false;
};
using LeftByFit = std::function<RestOfFit(const BodeData&)>;

/// The value without which a fit leaves less than a tenth of what it leaves of all, by fits without each of
/// those that stand farthest from the median of five neighbours, and that `shares` names as the largest
/// residuals. Of 16 values on, noise alone does that in fewer than 1 of 10,000. Where the noise is told by
/// the residuals themselves also a value that takes more than Gaussian noise does once in 1e9 tables (F test,
/// two values of 2 n - p), if what is left without it is noise. Precondition: as many shares as values.
std::optional<Outlier> outlier_of(const BodeData& data, std::span<const double> shares, double left_by_all,
                                  const LeftByFit& left_by_fit);

}  // namespace tacto::analysis
