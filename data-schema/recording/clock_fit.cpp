// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/clock_fit.hpp"

#include <cmath>

namespace tacto::schema {
namespace {

constexpr std::size_t kFewestPairs = 3;
constexpr double kShortestFit_s = 10;

struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
};

// Relative to the first pair: the hours since the host was started would cost precision.
struct Ahead {
  double host_s, device_ahead_s;
};

Ahead ahead_of(const ClockPair& pair, const ClockPair& first) {
  const double host_s = pair.host_s - first.host_s;
  return {host_s, pair.device_s - first.device_s - host_s};
}

Sums sums_of(std::span<const ClockPair> pairs) {
  Sums sums;
  for (const ClockPair& pair : pairs) {
    const auto [x, y] = ahead_of(pair, pairs.front());
    sums.n += 1, sums.x += x, sums.y += y, sums.xx += x * x, sums.xy += x * y;
  }
  return sums;
}

double sum_of_squares_left(std::span<const ClockPair> pairs, double slope, double intercept) {
  double left = 0;
  for (const ClockPair& pair : pairs) {
    const auto [x, y] = ahead_of(pair, pairs.front());
    const double residual = y - intercept - slope * x;
    left += residual * residual;
  }
  return left;
}

}  // namespace

std::optional<ClockFit> fit_clock(std::span<const ClockPair> pairs) {
  if (pairs.size() < kFewestPairs || pairs.back().host_s - pairs.front().host_s < kShortestFit_s)
    return std::nullopt;
  const auto [n, x, y, xx, xy] = sums_of(pairs);
  const double spread = xx - x * x / n, slope = (xy - x * y / n) / spread, intercept = (y - slope * x) / n;
  const double left = sum_of_squares_left(pairs, slope, intercept);
  const ClockFit fit{1e6 * slope, 1e6 * std::sqrt(left / (n - 2) / spread),
                     pairs.front().device_s - pairs.front().host_s + intercept, std::sqrt(left / n)};
  const bool sound =
      std::isfinite(fit.drift_ppm) && std::isfinite(fit.drift_uncertainty_ppm) && std::isfinite(fit.offset_s);
  return sound ? std::optional(fit) : std::nullopt;
}

}  // namespace tacto::schema
