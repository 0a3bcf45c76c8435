// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/rows/cpu_cost.hpp"

#include <algorithm>
#include <ctime>
#include <functional>
#include <iterator>
#include <utility>

#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

double thread_ns() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

}  // namespace

double median_cost(std::vector<double> values) {
  return schema::upper_median(std::span(values));
}

double median_difference(const std::vector<double>& more, const std::vector<double>& less) {
  std::vector<double> differences(more.size());
  std::ranges::transform(more, less, differences.begin(), std::minus<>());
  return median_cost(std::move(differences));
}

std::vector<std::vector<double>> costs_in_turns_ns(const std::vector<std::function<void()>>& works,
                                                   double units, int batches) {
  std::vector<std::vector<double>> times(works.size());
  for (int batch = 0; batch <= batches; ++batch)
    for (std::size_t i = 0; i < works.size(); ++i) {
      const double begun_ns = thread_ns();
      works[i]();
      if (batch > 0) times[i].push_back((thread_ns() - begun_ns) / units);
    }
  return times;
}

std::vector<double> median_costs_ns(const std::vector<std::function<void()>>& works, double units,
                                    int batches) {
  std::vector<double> medians;
  std::ranges::transform(costs_in_turns_ns(works, units, batches), std::back_inserter(medians), median_cost);
  return medians;
}

}  // namespace tacto::analysis
