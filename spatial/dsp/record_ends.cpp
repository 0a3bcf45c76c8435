// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/record_ends.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tacto::spatial {
namespace {

constexpr double kPaddingPeriods = 8;
constexpr double kBaselinePeriods = 2;

// A straight line by least squares through values[0 ... count), level at index 0.
struct Line {
  double level = 0, slope = 0;
  double at(double index) const { return level + slope * index; }
};

// `value(k)` is the k-th sample counted inwards from an end.
template <class Value>
Line fit_line(const Value& value, std::size_t count) {
  const double n = static_cast<double>(count), middle = (n - 1) / 2;
  double sum = 0, moment = 0;
  for (std::size_t k = 0; k < count; ++k) {
    sum += value(k);
    moment += (static_cast<double>(k) - middle) * value(k);
  }
  const double slope = moment * 12 / (n * (n * n - 1));
  return {sum / n - slope * middle, slope};
}

// 1 at the record's end, 0 at `count`, with two continuous derivatives.
double taper(std::size_t k, std::size_t count) {
  const double u = static_cast<double>(k) / static_cast<double>(count + 1);
  return 1 - u * u * u * (10 - 15 * u + 6 * u * u);
}

// Sample k = 1, 2 ... beyond an end.
template <class Value>
double beyond(const Value& value, const Line& line, double level, std::size_t k, std::size_t padding) {
  const double outwards = -static_cast<double>(k);
  const double mirrored = value(k) - line.at(-outwards);
  return level + (line.at(outwards) + mirrored - level) * taper(k, padding);
}

std::size_t samples_of(double periods, double low_hz, double sample_rate_hz, std::size_t most) {
  const double samples = low_hz > 0 ? periods / low_hz * sample_rate_hz : static_cast<double>(most);
  return samples < static_cast<double>(most) ? static_cast<std::size_t>(samples) : most;
}

}  // namespace

EndTreatment EndTreatment::for_lowest(double low_hz, double sample_rate_hz, std::size_t size) {
  assert(size >= 2);
  return {samples_of(kPaddingPeriods, low_hz, sample_rate_hz, size - 1),
          std::max<std::size_t>(2, samples_of(kBaselinePeriods, low_hz, sample_rate_hz, size))};
}

std::vector<double> extend_ends(std::span<const double> values, EndTreatment treatment, std::size_t length) {
  const std::size_t n = values.size(), padding = treatment.padding;
  assert(n >= 2 && padding < n && treatment.baseline >= 2 && treatment.baseline <= n &&
         length >= n + 2 * padding);
  const auto from_start = [&](std::size_t k) { return values[k]; };
  const auto from_end = [&](std::size_t k) { return values[n - 1 - k]; };
  const Line start = fit_line(from_start, treatment.baseline), end = fit_line(from_end, treatment.baseline);
  const double level = (start.level + end.level) / 2;
  std::vector<double> extended(length, level);
  std::ranges::copy(values, extended.begin() + static_cast<std::ptrdiff_t>(padding));
  for (std::size_t k = 1; k <= padding; ++k) {
    extended[padding - k] = beyond(from_start, start, level, k, padding);
    extended[padding + n - 1 + k] = beyond(from_end, end, level, k, padding);
  }
  return extended;
}

std::vector<double> extend_odd(std::span<const double> values, std::size_t padding) {
  assert(padding < values.size());
  const std::size_t n = values.size();
  std::vector<double> extended(n + 2 * padding);
  std::ranges::copy(values, extended.begin() + static_cast<std::ptrdiff_t>(padding));
  for (std::size_t k = 1; k <= padding; ++k) {
    extended[padding - k] = 2 * values.front() - values[k];
    extended[padding + n - 1 + k] = 2 * values.back() - values[n - 1 - k];
  }
  return extended;
}

}  // namespace tacto::spatial
