// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/thinned.hpp"

#include <algorithm>

#include "spatial/dsp/resample/low_pass.hpp"

namespace tacto::spatial {
namespace {

// The filter's middle is at values[at].
double filtered_at(std::span<const double> values, std::ptrdiff_t at, std::span<const double> filter) {
  const auto reach = static_cast<std::ptrdiff_t>(filter.size() / 2);
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  double sum = 0;
  for (std::ptrdiff_t i = -reach; i <= reach; ++i)
    sum += filter[static_cast<std::size_t>(i + reach)] *
           values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at + i, 0, last))];
  return sum;
}

}  // namespace

std::vector<double> thinned(std::span<const double> values, std::size_t n) {
  if (n == 1) return {values.begin(), values.end()};
  const auto times = static_cast<double>(n);
  const std::vector<double> filter = low_pass(kThinnedPass / times, (1 - kThinnedPass) / times);
  std::vector<double> kept;
  for (std::size_t at = 0; at < values.size(); at += n)
    kept.push_back(filtered_at(values, static_cast<std::ptrdiff_t>(at), filter));
  return kept;
}

}  // namespace tacto::spatial
