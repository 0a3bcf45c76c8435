// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/rate_chain.hpp"

#include <utility>

namespace tacto::spatial {
namespace {

constexpr double kError = 1e-8;
// The transition of the last half-band filter is then a tenth of its higher rate: 27 taps on each side.
constexpr double kLeastRate = 2.5;

}  // namespace

RateChain::RateChain(double sample_rate_hz, double highest_hz) {
  for (double rate_hz = sample_rate_hz; rate_hz / 2 >= kLeastRate * highest_hz; rate_hz /= 2) {
    const HalfBand filter(highest_hz / rate_hz, kError);
    halvers_.emplace_back(filter);
    doublers_.emplace_back(filter);
  }
}

std::size_t RateChain::delay() const {
  std::size_t samples = 0;
  for (std::size_t i = 0; i < halvers_.size(); ++i)
    samples += (halvers_[i].delay() + doublers_[i].delay()) << (i + 1);
  return samples;
}

std::size_t RateChain::memory() const {
  return 2 * (delay() + factor());
}

std::span<const double> RateChain::down(std::span<const double> values) {
  for (Halver& halver : halvers_) {
    lower_next_.resize(values.size() / 2);
    halver.run(values, lower_next_);
    std::swap(lower_, lower_next_);
    values = lower_;
  }
  return values;
}

std::span<const double> RateChain::up(std::span<const double> values) {
  for (std::size_t i = doublers_.size(); i-- > 0;) {
    upper_next_.resize(2 * values.size());
    doublers_[i].run(values, upper_next_);
    std::swap(upper_, upper_next_);
    values = upper_;
  }
  return values;
}

void RateChain::reset() {
  for (Halver& halver : halvers_) halver.reset();
  for (Doubler& doubler : doublers_) doubler.reset();
}

}  // namespace tacto::spatial
