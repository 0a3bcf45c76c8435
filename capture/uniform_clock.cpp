// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/uniform_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tacto::capture {
namespace {

using schema::fail;
using schema::Fault;
using schema::Result;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

Result<std::vector<double>> steps_between(std::span<const double> time_s, const PlaceOf& place_of,
                                          const std::string& file) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    steps.push_back(time_s[i] - time_s[i - 1]);
    if (!(steps.back() > 0))
      return fail(Fault::malformed,
                  fmt::format("time goes from {} s to {} s: it must grow", time_s[i - 1], time_s[i]),
                  fmt::format("{}: {}", file, place_of(i)));
  }
  return steps;
}

// Not the median itself: printed times of 3 kHz step by 0.3, 0.3, 0.4 ms, and only their mean is the period.
double period_of(const std::vector<double>& steps) {
  const double median = median_of(steps);
  double sum = 0;
  std::size_t count = 0;
  for (const double step : steps) {
    if (std::abs(step - median) > median / 2) continue;
    sum += step;
    ++count;
  }
  return sum / static_cast<double>(count);
}

double whole_where_close(double rate_hz) {
  const double whole = std::round(rate_hz);
  return std::abs(rate_hz - whole) <= 1e-9 * rate_hz ? whole : rate_hz;
}

tl::unexpected<schema::Error> uneven(double step, double period, const std::string& where) {
  return fail(Fault::malformed,
              fmt::format("the time step of {:.6g} s is no whole number of periods of {:.6g} s (within {:g})",
                          step, period, kMostJitter),
              where, "resample it evenly where it was made, or give --rate instead of --time-column");
}

}  // namespace

Result<UniformClock> find_uniform_clock(std::span<const double> time_s, const PlaceOf& place_of,
                                        const std::string& file) {
  if (time_s.size() < 3)
    return fail(Fault::malformed, "has too few rows to find a rate from their times", file);
  const auto steps = steps_between(time_s, place_of, file);
  if (!steps) return schema::forward_error(steps);
  const double period = period_of(*steps);
  UniformClock clock;
  std::uint64_t sequence = 0;
  for (std::size_t i = 0; i < steps->size(); ++i) {
    const double ticks = std::max(1.0, std::round((*steps)[i] / period));
    if (std::abs((*steps)[i] / period - ticks) > kMostJitter)
      return uneven((*steps)[i], period, fmt::format("{}: {}", file, place_of(i + 1)));
    ++sequence;
    const auto missing = static_cast<std::uint64_t>(ticks) - 1;
    if (missing > 0) clock.gaps.push_back({i + 1, sequence, missing});
    sequence += missing;
  }
  clock.rate_hz = whole_where_close(static_cast<double>(sequence) / (time_s.back() - time_s.front()));
  return clock;
}

}  // namespace tacto::capture
