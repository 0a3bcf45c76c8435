// SPDX-License-Identifier: GPL-3.0-or-later
// What work costs in CPU time.
#pragma once

#include <functional>
#include <vector>

namespace tacto::analysis {

/// Runs each work `batches` times, in turns, so that a machine that gets slower meanwhile does so for all;
/// the first turn is not counted. Gives the median of each, ns of this thread's CPU time over `units`, what
/// one run of a work does of.
std::vector<double> median_costs_ns(const std::vector<std::function<void()>>& works, double units,
                                    int batches);

/// The same of one work, in 15 batches.
inline double median_cost_ns(const std::function<void()>& work, double units) {
  return median_costs_ns({work}, units, 15).front();
}

}  // namespace tacto::analysis
