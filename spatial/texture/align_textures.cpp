// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/align_textures.hpp"

#include <cmath>
#include <cstddef>

#include "spatial/numbers/lag_correlation.hpp"

namespace tacto::spatial {
namespace {

// Below this, two textures share less than a tenth of their power, so that agreement may be chance.
constexpr double kLeastCorrelation = 0.3;

using Index = std::ptrdiff_t;

}  // namespace

Alignment align(const BenchValues& a, const BenchValues& b, double range) {
  const LagCorrelation correlation(a.values, b.values);
  const auto apart = static_cast<Index>(std::lround(a.first - b.first));
  const auto reach = static_cast<Index>(std::floor(range));
  Index best = -reach;
  for (Index lag = -reach; lag <= reach; ++lag)
    if (correlation.at(apart + lag) > correlation.at(apart + best)) best = lag;
  const double top = correlation.at(apart + best);
  if (top < kLeastCorrelation || best == -reach || best == reach) return {0, correlation.at(apart), false};
  const double before = correlation.at(apart + best - 1), after = correlation.at(apart + best + 1);
  const double bend = before - 2 * top + after, off = bend < 0 ? (before - after) / (2 * bend) : 0;
  return {-(static_cast<double>(best) + off), top - (before - after) * off / 4, true};
}

}  // namespace tacto::spatial
