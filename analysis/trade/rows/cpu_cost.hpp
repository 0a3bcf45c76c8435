// SPDX-License-Identifier: GPL-3.0-or-later
// Measures CPU time.
#pragma once

#include <functional>
#include <vector>

namespace tacto::analysis {

/// Runs each work `batches` times, in turns, so that a change of the machine's speed affects all equally; the
/// first turn is not counted. Returns for each work the CPU time of this thread in ns per unit, one value per
/// turn; a run of a work is `units` units.
std::vector<std::vector<double>> costs_in_turns_ns(const std::vector<std::function<void()>>& works,
                                                   double units, int batches);

double median_cost(std::vector<double> values);

/// Difference of two costs: the median over the turns.
double median_difference(const std::vector<double>& more, const std::vector<double>& less);

/// The median of each work.
std::vector<double> median_costs_ns(const std::vector<std::function<void()>>& works, double units,
                                    int batches);

/// The same for one work, in 15 batches.
inline double median_cost_ns(const std::function<void()>& work, double units) {
  return median_costs_ns({work}, units, 15).front();
}

}  // namespace tacto::analysis
