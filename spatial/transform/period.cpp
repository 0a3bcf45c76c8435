// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/transform/period.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "spatial/numbers/lag_correlation.hpp"
#include "spatial/numbers/parabolic_peak.hpp"

namespace tacto::spatial {
namespace {

using Lag = std::ptrdiff_t;

// The error of a found period of 1e-6, over 20,000 samples.
constexpr double kWholePeriods = 0.02;
constexpr double kPastTheMainLobe = 0.5;
// A shorter lag is the period if its correlation misses the best one by no more than this, or by this share
// of what the best one misses (noise).
constexpr double kAsWell = 1e-3, kAsWellShare = 0.1;
constexpr int kMostSteps = 4;

// The lag near `lag` for which sum (y(x) - y(x + lag))^2 is least: Gauss-Newton from the nearest whole lag,
// with the slope over `wide` samples as instrument, so that noise from sample to sample does not count as
// slope.
double refined(std::span<const double> y, double lag, Lag wide) {
  const auto size = static_cast<Lag>(y.size());
  for (int step = 0; step < kMostSteps; ++step) {
    const auto whole = static_cast<Lag>(std::lround(lag));
    double missed = 0, slopes = 0;
    for (Lag i = wide; i + whole + wide < size; ++i) {
      const double *a = y.data() + i, *b = a + whole;
      const double far = a[wide] - a[-wide] + b[wide] - b[-wide];
      missed += (*a - *b) * far;
      slopes += 0.25 * (a[1] - a[-1] + b[1] - b[-1]) * far;
    }
    if (!(slopes > 0)) return lag;
    const double next = static_cast<double>(whole) + missed / slopes;
    if (!(std::abs(next - lag) < static_cast<double>(wide))) return lag;
    lag = next;
    if (std::lround(lag) == whole) break;
  }
  return lag;
}

// The first lag at which the correlation has fallen below kPastTheMainLobe; `last` if it does not.
Lag main_lobe(const LagCorrelation& correlation, Lag last) {
  Lag lag = 1;
  while (lag < last && correlation.at(lag) >= kPastTheMainLobe) ++lag;
  return lag;
}

// The correlation at the top of a maximum, between whole lags; -1 where there is none.
double peak_at(const LagCorrelation& correlation, Lag lag) {
  const double before = correlation.at(lag - 1), here = correlation.at(lag), after = correlation.at(lag + 1);
  return here >= before && here > after ? parabolic_peak(before, here, after).value : -1;
}

}  // namespace

std::vector<double> about_mean(std::span<const double> values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::vector<double> centred(values.begin(), values.end());
  for (double& value : centred) value -= mean;
  return centred;
}

std::optional<double> find_period(std::span<const double> values) {
  const auto size = static_cast<Lag>(values.size());
  if (size < 8) return std::nullopt;
  const std::vector<double> y = about_mean(values);
  const LagCorrelation correlation(y, y);
  const Lag last = size / 2, lobe = main_lobe(correlation, last);
  double best = 0;
  for (Lag lag = lobe; lag < last; ++lag) best = std::max(best, peak_at(correlation, lag));
  if (best < kLeastPeriodCorrelation) return std::nullopt;
  const double enough = best - std::max(kAsWell, kAsWellShare * (1 - best));
  Lag first = lobe;
  while (peak_at(correlation, first) < enough) ++first;

  double period = refined(y, static_cast<double>(first), lobe);
  const double longest = 2.0 / 3 * static_cast<double>(size);
  for (double multiple = 2; multiple * period <= longest; multiple *= 2)
    period = refined(y, multiple * period, lobe) / multiple;
  if (const double multiple = std::floor(longest / period); multiple > 1)
    period = refined(y, multiple * period, lobe) / multiple;
  return period;
}

bool is_whole_periods(std::size_t size, double period) {
  const double samples = static_cast<double>(size), whole = std::round(samples / period);
  return whole >= 2 && std::abs(samples - whole * period) <= kWholePeriods;
}

}  // namespace tacto::spatial
