// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/sweep_generator.hpp"

namespace tacto::core {
namespace {

constexpr uint32_t kQuarter = UINT32_C(1) << 30;
constexpr float kRadiansPerPhase = 1.5707963267948966F / static_cast<float>(kQuarter);

// frequency / rate x 2^64, bit by bit: small cores have no 64-bit division.
uint64_t turns_q64(uint64_t frequency, uint64_t rate) noexcept {
  uint64_t turns = 0;
  for (int bit = 0; bit < 64; ++bit) {
    frequency <<= 1;
    turns = (turns << 1) | (frequency >= rate ? 1U : 0U);
    if (frequency >= rate) frequency -= rate;
  }
  return turns;
}

// a x b / 2^32 without overflow of the 96-bit product.
uint64_t scaled(uint64_t a, uint32_t b) noexcept {
  return (a >> 32) * b + (((a & 0xFFFFFFFFU) * b) >> 32);
}

}  // namespace

float sine_of_phase(uint32_t phase) noexcept {
  const bool mirrored = (phase & kQuarter) != 0, negative = (phase & (kQuarter << 1)) != 0;
  const uint32_t within = phase & (kQuarter - 1);
  const float x = static_cast<float>(mirrored ? kQuarter - within : within) * kRadiansPerPhase;
  const float s = x * x;
  const float sine = x * (1 + s * (-1.0F / 6 + s * (1.0F / 120 + s * (-1.0F / 5040 + s * (1.0F / 362880)))));
  return negative ? -sine : sine;
}

bool SweepGenerator::set(const wire::Sweep& sweep, uint32_t rate_millihertz) noexcept {
  const bool sound = sweep.from_millihertz > 0 && sweep.from_millihertz <= sweep.to_millihertz &&
                     sweep.to_millihertz < rate_millihertz / 2 && sweep.growth_q32 > 0;
  if (!sound) return false;
  amplitude_v_ = sweep.amplitude_v;
  phase_ = 0;
  step_ = turns_q64(sweep.from_millihertz, rate_millihertz);
  last_step_ = turns_q64(sweep.to_millihertz, rate_millihertz);
  growth_q32_ = sweep.growth_q32;
  return true;
}

float SweepGenerator::next() noexcept {
  if (done()) return 0;
  const float value = amplitude_v_ * sine_of_phase(static_cast<uint32_t>(phase_ >> 32));
  phase_ += step_;
  step_ += scaled(step_, growth_q32_);
  return value;
}

}  // namespace tacto::core
