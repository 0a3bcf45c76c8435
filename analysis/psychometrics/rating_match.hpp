// SPDX-License-Identifier: GPL-3.0-or-later
// The ratio that seems equal to a reference, from ratings of many ratios.
#pragma once

#include <span>

#include "analysis/psychometrics/psychometric_fit.hpp"

namespace tacto::analysis {

/// A stimulus of `ratio` times the reference, rated below 0, 0 or above 0 against it.
struct RatedRatio {
  double ratio = 0;
  int rating = 0;
};

/// The match m: the middle of the ratios that are rated 0. Model: normal errors of deviation s; below m - h
/// the rating is below 0, above m + h above it; a lapse is 'below' or 'above', each half of the time. So
/// zeros count, and which ratios were asked does not shift the match, as it shifts the mean ratio of the
/// zeros. Median and 95 % interval of the posterior on a grid, flat in m within the ratios, and in s and h up
/// to half of their range; of the lapse Beta(1, 19). Errors: unsuitable: fewer than two ratios, no rating
/// below 0 or none above it (a bound). Pure; up to a second for 100 ratings.
schema::Result<Estimate> match_of_ratings(std::span<const RatedRatio> ratings);

}  // namespace tacto::analysis
