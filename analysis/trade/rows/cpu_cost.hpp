// SPDX-License-Identifier: GPL-3.0-or-later
// What work costs in CPU time.
#pragma once

#include <functional>
#include <vector>

namespace tacto::analysis {

/// Runs each work `batches` times, in turns, so that a machine that gets slower meanwhile does so for all;
/// the first turn is not counted. Of each work, turn by turn, ns of this thread's CPU time over `units`, what
/// one run of a work does of.
std::vector<std::vector<double>> costs_in_turns_ns(const std::vector<std::function<void()>>& works,
                                                   double units, int batches);

double median_cost(std::vector<double> values);

/// What one costs more than another: the median over the turns.
double median_difference(const std::vector<double>& more, const std::vector<double>& less);

/// The median of each.
std::vector<double> median_costs_ns(const std::vector<std::function<void()>>& works, double units,
                                    int batches);

/// The same of one work, in 15 batches.
inline double median_cost_ns(const std::function<void()>& work, double units) {
  return median_costs_ns({work}, units, 15).front();
}

}  // namespace tacto::analysis
