// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/decimation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "spatial/dsp/resample/low_pass.hpp"

namespace tacto::spatial {
namespace {

constexpr double kMargin = 50;  // range of leakage beyond the last bin, in 1 / window
constexpr double kRoom = 3;  // smallest 1 / factor over pass: a third of the band for the filter's transition
constexpr std::size_t kDeepest = 4096;

std::size_t largest_divisor(std::size_t of, std::size_t most) {
  for (std::size_t divisor = std::min(most, kDeepest); divisor > 1; --divisor)
    if (of % divisor == 0) return divisor;
  return 1;
}

// Multiplications and additions for one row: 16 per cycle in a transform of two rows, 8 in a filter.
double transform_cost(double length, double window) {
  return 5 * length * std::log2(length) / 2 / 2 + window;
}

double filter_cost(const FrameShape& shape, const Decimation& d) {
  const auto grid = static_cast<double>(d.grid);
  double taps = 0;
  if (d.grid > 1) taps += 2.0 * static_cast<double>(low_pass_reach(d.pass, coarse_stop(d)));
  if (d.grid < d.factor) taps += 2.0 * static_cast<double>(low_pass_reach(d.pass * grid, d.stop * grid));
  return taps / grid * static_cast<double>(std::min(shape.hop, shape.window));
}

bool pays(const FrameShape& shape, const Decimation& d) {
  const auto factor = static_cast<double>(d.factor);
  const auto padded = static_cast<double>(shape.padded), window = static_cast<double>(shape.window);
  return filter_cost(shape, d) + transform_cost(padded / factor, window / factor) <
         transform_cost(padded, window);
}

}  // namespace

double coarse_stop(const Decimation& d) {
  return d.grid == d.factor ? d.stop : 1 / static_cast<double>(d.grid) - d.stop;
}

Decimation decimation_for(const FrameShape& shape) {
  Decimation d;
  const double highest = static_cast<double>(shape.bins - 1) / static_cast<double>(shape.padded);
  const double pass = highest + kMargin / static_cast<double>(shape.window);
  const double most = std::floor(1 / (kRoom * pass) * (1 + 1e-9));
  if (most < 2) return d;  // the requested band needs full resolution
  d.factor = largest_divisor(shape.padded, static_cast<std::size_t>(most));
  d.grid = std::gcd(shape.hop, d.factor);
  d.pass = pass;
  d.stop = 1 / static_cast<double>(d.factor) - pass;
  if (d.factor == 1)
    return {.whole_because =
                fmt::format("no number from 2 to {} divides the {} padded samples", most, shape.padded)};
  if (!pays(shape, d))
    return {.whole_because = fmt::format(
                "with a hop of {} samples the filter would need more time than it saves", shape.hop)};
  return d;
}

}  // namespace tacto::spatial
