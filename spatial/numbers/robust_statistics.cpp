// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/numbers/robust_statistics.hpp"

#include <algorithm>
#include <limits>

#include "data-schema/base/statistics.hpp"

namespace tacto::spatial {

template <class Value>
double median_of(std::vector<Value>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(schema::upper_median(std::span(values)));
}

template double median_of(std::vector<float>& values);
template double median_of(std::vector<double>& values);

double robust_slope(std::span<const double> x, std::span<const double> y) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = i + 1; j < x.size(); ++j)
      if (x[i] != x[j]) slopes.push_back((y[j] - y[i]) / (x[j] - x[i]));
  return slopes.empty() ? 0 : median_of(slopes);
}

}  // namespace tacto::spatial
