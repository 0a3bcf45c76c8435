// SPDX-License-Identifier: GPL-3.0-or-later
// An encoder's scale from a known travel.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"

namespace tacto::capture {

struct TravelScale {
  Uncertain scale;    ///< m per count
  int direction = 1;  ///< of the first travel: 1 if the counts increased
  std::vector<std::string> notes;
};

/// From the differences in counts of equal travels, in either direction. The scale is travel / mean
/// |difference| and positive, because +x is the direction in which the counts increase. Uncertainty: the
/// scatter of the differences (type A, from two on); the rounding of a count at both ends, each with a
/// rectangular distribution (sqrt(2/12) counts per travel); and the uncertainty of the travel. `step` is the
/// smallest difference of the channel: 1 for an encoder, more for left-justified converter codes (step_of()).
/// Errors: usage: a travel of zero or less; unsuitable: no difference, a difference below 100 steps, or
/// differences that deviate by more than 5 %.
schema::Result<TravelScale> scale_by_travel(std::span<const double> differences, double travel_m,
                                            double travel_uncertainty_m, double step = 1);

/// The shorter way between two stored counts: a 32-bit counter that overflows at 2^31 continues.
double travelled_counts(double from, double to);

/// The differences in a part of a recording: between consecutive marks, or without marks between its
/// beginning and its end. Errors: usage: no such channel; unsuitable: one mark only.
schema::Result<std::vector<double>> count_differences(const Take& take, const std::string& channel);

}  // namespace tacto::capture
