// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/rate_chain.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>
#include <utility>

#include "data-schema/base/decibels.hpp"
#include "spatial/dsp/fourier/simd_clones.hpp"

namespace tacto::spatial {
namespace {

// Kaiser's formulas for the shape of a window and for its number of taps for a transition of `width` cycles
// per sample.
double kaiser_shape(double attenuation_db) {
  return 0.1102 * (attenuation_db - 8.7);
}

double kaiser_taps(double attenuation_db, double width) {
  return (attenuation_db - 8) / (2.285 * 2 * std::numbers::pi * width);
}

// A vector of four values.
using Lanes [[gnu::vector_size(32)]] = double;
constexpr std::size_t kHalfBandLanes = 4, kTile = 4 * kHalfBandLanes;

TACTO_SIMD_INLINE void add_pair(Lanes& sum, double tap, const double* before, const double* after) {
  Lanes low, high;
  std::memcpy(&low, before, sizeof low);
  std::memcpy(&high, after, sizeof high);
  sum += tap * (low + high);
}

// out[j] = sum over k of taps[k] (before[j - k] + after[j + k]), for kTile values. Written with explicit
// vectors, because compilers otherwise vectorise over k and shuffle.
TACTO_SIMD_INLINE void tile_sum(const double* before, const double* after, const double* taps,
                                std::size_t count, double* out) {
  Lanes sum0 = {}, sum1 = {}, sum2 = {}, sum3 = {};
  for (std::size_t k = 0; k < count; ++k) {
    const double* low = before - k;
    const double* high = after + k;
    add_pair(sum0, taps[k], low, high);
    add_pair(sum1, taps[k], low + kHalfBandLanes, high + kHalfBandLanes);
    add_pair(sum2, taps[k], low + 2 * kHalfBandLanes, high + 2 * kHalfBandLanes);
    add_pair(sum3, taps[k], low + 3 * kHalfBandLanes, high + 3 * kHalfBandLanes);
  }
  std::memcpy(out, &sum0, sizeof sum0);
  std::memcpy(out + kHalfBandLanes, &sum1, sizeof sum1);
  std::memcpy(out + 2 * kHalfBandLanes, &sum2, sizeof sum2);
  std::memcpy(out + 3 * kHalfBandLanes, &sum3, sizeof sum3);
}

// The same for n values.
TACTO_SIMD_CLONES
void symmetric_sum(const double* before, const double* after, const double* taps, std::size_t count,
                   double* out, std::size_t n) {
  std::size_t j = 0;
  for (; j + kTile <= n; j += kTile) tile_sum(before + j, after + j, taps, count, out + j);
  for (; j < n; ++j) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += taps[k] * (*(before + j - k) + after[j + k]);
    out[j] = sum;
  }
}

TACTO_SIMD_CLONES
void split(const double* in, std::size_t pairs, double* even, double* odd) {
  for (std::size_t j = 0; j < pairs; ++j) {
    even[j] = in[2 * j];
    odd[j] = in[2 * j + 1];
  }
}

TACTO_SIMD_CLONES
void add_half(const double* values, std::size_t n, double* out) {
  for (std::size_t j = 0; j < n; ++j) out[j] += 0.5 * values[j];
}

TACTO_SIMD_CLONES
void interleave(const double* even, const double* odd, std::size_t pairs, double* out) {
  for (std::size_t j = 0; j < pairs; ++j) {
    out[2 * j] = even[j];
    out[2 * j + 1] = 2 * odd[j];
  }
}

// Moves the last `kept` values to the front.
void keep_last(std::vector<double>& values, std::size_t kept, std::size_t used) {
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(used), kept, values.begin());
}

constexpr double kError = 1e-8;
// The transition of the last half-band filter is then a tenth of its higher rate: 27 taps on each side.
constexpr double kLeastRate = 2.5;

}  // namespace

HalfBand::HalfBand(double passed, double error) {
  assert(passed > 0 && passed < 0.25 && error > 0);
  const double attenuation_db = -schema::amplitude_db(error), shape = kaiser_shape(attenuation_db);
  const double taps = kaiser_taps(attenuation_db, 0.5 - 2 * passed);
  const auto count = static_cast<std::size_t>(std::ceil((taps + 1) / 4));
  const double reach = 2 * static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double place = 2 * static_cast<double>(k) + 1, share = place / reach;
    const double sinc = (k % 2 == 0 ? 1 : -1) / (std::numbers::pi * place);
    taps_.push_back(sinc * std::cyl_bessel_i(0, shape * std::sqrt(1 - share * share)));
  }
  const double sum = std::accumulate(taps_.begin(), taps_.end(), 0.0);
  for (double& tap : taps_) tap *= 0.25 / sum;
}

Halver::Halver(HalfBand filter) : filter_(std::move(filter)) {
  reset();
}

void Halver::reset() {
  even_.assign(filter_.size() - 1, 0);
  odd_.assign(2 * filter_.size() - 1, 0);
}

void Halver::run(std::span<const double> in, std::span<double> out) {
  assert(in.size() % 2 == 0 && out.size() == in.size() / 2);
  const std::size_t taps = filter_.size(), pairs = out.size(), evens = taps - 1, odds = 2 * taps - 1;
  if (even_.size() < evens + pairs) even_.resize(evens + pairs);
  if (odd_.size() < odds + pairs) odd_.resize(odds + pairs);
  split(in.data(), pairs, even_.data() + evens, odd_.data() + odds);
  symmetric_sum(odd_.data() + taps - 1, odd_.data() + taps, filter_.taps().data(), taps, out.data(), pairs);
  add_half(even_.data(), pairs, out.data());
  keep_last(even_, evens, pairs);
  keep_last(odd_, odds, pairs);
}

Doubler::Doubler(HalfBand filter) : filter_(std::move(filter)) {
  reset();
}

void Doubler::reset() {
  values_.assign(2 * filter_.size() - 1, 0);
}

void Doubler::run(std::span<const double> in, std::span<double> out) {
  assert(out.size() == 2 * in.size());
  const std::size_t taps = filter_.size(), n = in.size(), kept = 2 * taps - 1;
  if (values_.size() < kept + n) values_.resize(kept + n);
  between_.resize(n);
  std::ranges::copy(in, values_.begin() + static_cast<std::ptrdiff_t>(kept));
  const double* middle = values_.data() + taps - 1;
  symmetric_sum(middle, middle + 1, filter_.taps().data(), taps, between_.data(), n);
  interleave(middle, between_.data(), n, out.data());
  keep_last(values_, kept, n);
}

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
