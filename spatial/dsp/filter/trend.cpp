// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/trend.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "spatial/dsp/fourier/simd_clones.hpp"

namespace tacto::spatial {
namespace {

// Independent partial sums: in a single sum each addition would wait for the one before.
constexpr std::size_t kTrendLanes = 8;

TACTO_SIMD_INLINE double total(const double (&sums)[kTrendLanes]) {
  double sum = 0;
  for (const double each : sums) sum += each;
  return sum;
}

}  // namespace

TACTO_SIMD_CLONES
double sum_above(std::span<const double> values, double level) {
  double sums[kTrendLanes] = {};
  std::size_t i = 0;
  for (; i + kTrendLanes <= values.size(); i += kTrendLanes)
    for (std::size_t lane = 0; lane < kTrendLanes; ++lane) sums[lane] += values[i + lane] - level;
  for (; i < values.size(); ++i) sums[0] += values[i] - level;
  return total(sums);
}

TACTO_SIMD_CLONES
Trend trend_of(std::span<const double> values) {
  assert(values.size() >= 2);
  const auto count = static_cast<double>(values.size());
  Trend trend;
  trend.mean = values[0] + sum_above(values, values[0]) / count;
  double moments[kTrendLanes] = {}, largest[kTrendLanes] = {};
  const auto add = [&](std::size_t i, std::size_t lane, double position) {
    const double above = values[i] - trend.mean;
    moments[lane] += position * above;
    largest[lane] = std::max(largest[lane], std::abs(above));
  };
  std::size_t i = 0;
  double position = -0.5 * (count - 1);  // from the middle
  for (; i + kTrendLanes <= values.size(); i += kTrendLanes, position += kTrendLanes)
    for (std::size_t lane = 0; lane < kTrendLanes; ++lane)
      add(i + lane, lane, position + static_cast<double>(lane));
  for (; i < values.size(); ++i) add(i, 0, position++);
  trend.slope = 12 * total(moments) / (count * (count * count - 1));
  trend.largest = *std::ranges::max_element(largest);
  return trend;
}

TACTO_SIMD_CLONES
void subtract_line(std::span<const double> values, double level, double slope, double scale,
                   std::span<float> out) {
  assert(values.size() == out.size());
  const double* __restrict in = values.data();
  float* __restrict result = out.data();
  const auto count = static_cast<int>(values.size());  // an int becomes a number in one instruction
  for (int i = 0; i < count; ++i)
    result[i] = static_cast<float>((in[i] - level - slope * static_cast<double>(i)) * scale);
}

}  // namespace tacto::spatial
