// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/pure_delay.hpp"

#include <numbers>

namespace tacto::analysis {
namespace {

constexpr int kPeriods = 2, kToAPeriod = 8;
constexpr double kGolden = 0.6180339887498949, kTolerance = 1e-3;  // of a period

BodeData earlier_by(BodeData data, double delay_s) {
  for (std::size_t i = 0; i < data.size(); ++i)
    data.response[i] *= std::polar(1.0, 2 * std::numbers::pi * data.frequency_hz[i] * delay_s);
  return data;
}

}  // namespace

PureDelay best_delay(const BodeData& data, const std::function<double(const BodeData&)>& left_by) {
  const double period_s = 1 / data.frequency_hz.back(), step_s = period_s / kToAPeriod;
  const auto tried = [&](double delay_s) { return PureDelay{delay_s, left_by(earlier_by(data, delay_s))}; };
  PureDelay best = tried(0);
  for (int i = -kPeriods * kToAPeriod; i <= kPeriods * kToAPeriod; ++i)
    if (const PureDelay one = tried(i * step_s); one.left < best.left) best = one;
  double low_s = best.delay_s - step_s, high_s = best.delay_s + step_s;
  while (high_s - low_s > kTolerance * period_s) {
    const PureDelay a = tried(high_s - kGolden * (high_s - low_s));
    const PureDelay b = tried(low_s + kGolden * (high_s - low_s));
    (a.left < b.left ? high_s : low_s) = a.left < b.left ? b.delay_s : a.delay_s;
    if (a.left < best.left) best = a;
    if (b.left < best.left) best = b;
  }
  return best;
}

}  // namespace tacto::analysis
