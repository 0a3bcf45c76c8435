// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/local_mean.hpp"

#include <algorithm>
#include <numeric>

namespace tacto::analysis {

std::vector<double> running_sums(const std::vector<double>& values) {
  std::vector<double> sums(values.size() + 1, 0.0);
  std::partial_sum(values.begin(), values.end(), sums.begin() + 1);
  return sums;
}

std::vector<double> local_mean(const std::vector<double>& values, std::size_t reach) {
  const std::vector<double> sums = running_sums(values);
  std::vector<double> means(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::size_t r = std::min({reach, k, values.size() - 1 - k});
    means[k] = (sums[k + r + 1] - sums[k - r]) / static_cast<double>(2 * r + 1);
  }
  return means;
}

}  // namespace tacto::analysis
