// SPDX-License-Identifier: GPL-3.0-or-later
// An encoder's scale by a known travel.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"

namespace tacto::capture {

struct TravelScale {
  Uncertain scale;    ///< m per count
  int direction = 1;  ///< of the first travel: 1 where the counts went up
  std::vector<std::string> notes;
};

/// From the differences in counts of equal travels, there or back. The scale is travel / mean |difference|
/// and above zero: +x is the way in which the counts grow. Uncertainty: the scatter of the differences (type
/// A, from two on), the two ends of a count each as rectangles (sqrt(2/12) counts a travel), and the
/// travel's own. `step` is the
/// smallest difference that the channel can show: 1 of an encoder, more of a converter's left-justified codes
/// (step_of()). Errors: usage: a travel that is none; unsuitable: no difference, one below 100 steps, or
/// ones that disagree by more than 5 %.
schema::Result<TravelScale> scale_by_travel(std::span<const double> differences, double travel_m,
                                            double travel_uncertainty_m, double step = 1);

/// From one stored count to another, the short way: a counter of 32 bits that passes 2^31 goes on.
double travelled_counts(double from, double to);

/// The differences in a recording's part: between its marks, one after the other; without marks, between its
/// beginning and its end. Errors: usage: no such channel; unsuitable: one mark only.
schema::Result<std::vector<double>> count_differences(const Take& take, const std::string& channel);

}  // namespace tacto::capture
