// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/record_ends.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tacto::spatial {
namespace {

constexpr double kPaddingPeriods = 8;
constexpr double kBaselinePeriods = 2;
// Consumed values are erased only when there are this many of them.
constexpr std::size_t kLeastErased = 8192;

// Least-squares straight line through values[0 ... count); `level` is at index 0.
struct Line {
  double level = 0, slope = 0;
  double at(double index) const { return level + slope * index; }
};

// `value(k)` is the k-th sample from an end inwards.
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

ExtendedRecord::ExtendedRecord(double low_hz, double sample_rate_hz)
    : low_hz_(low_hz),
      sample_rate_hz_(sample_rate_hz),
      most_(EndTreatment::for_lowest(low_hz, sample_rate_hz, std::numeric_limits<std::size_t>::max())) {}

void ExtendedRecord::reset() {
  held_.clear();
  begun_ = false;
}

void ExtendedRecord::begin(EndTreatment treatment, std::vector<double>& extended) {
  treatment_ = treatment;
  const auto value = [&](std::size_t k) { return held_[k]; };
  const Line line = fit_line(value, treatment.baseline);
  start_level_ = line.level;
  for (std::size_t k = treatment.padding; k >= 1; --k)
    extended.push_back(beyond(value, line, line.level, k, treatment.padding) - start_level_);
  append_record(held_, extended);
  begun_ = true;
}

void ExtendedRecord::append_record(std::span<const double> values, std::vector<double>& extended) const {
  const std::size_t before = extended.size();
  extended.resize(before + values.size());
  for (std::size_t i = 0; i < values.size(); ++i) extended[before + i] = values[i] - start_level_;
}

void ExtendedRecord::push(std::span<const double> values, std::vector<double>& extended) {
  held_.insert(held_.end(), values.begin(), values.end());
  const std::size_t needed = std::max(most_.padding + 1, most_.baseline);
  if (begun_)
    append_record(values, extended);
  else if (held_.size() >= needed)
    begin(most_, extended);
  if (begun_ && held_.size() > 2 * needed + kLeastErased)
    held_.erase(held_.begin(), held_.end() - static_cast<std::ptrdiff_t>(needed));
}

void ExtendedRecord::finish(std::vector<double>& extended) {
  assert(held_.size() >= 2);
  if (!begun_) begin(EndTreatment::for_lowest(low_hz_, sample_rate_hz_, held_.size()), extended);
  const auto value = [&](std::size_t k) { return held_[held_.size() - 1 - k]; };
  const Line line = fit_line(value, treatment_.baseline);
  for (std::size_t k = 1; k <= treatment_.padding; ++k)
    extended.push_back(beyond(value, line, line.level, k, treatment_.padding) - start_level_);
  final_value_ = line.level - start_level_;
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
