// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/scene/force_limiter.hpp"

namespace tacto::core {
namespace {

float square_sum(const float* values, uint32_t count) noexcept {
  float sum = 0;
  for (uint32_t i = 0; i < count; ++i) sum += values[i] * values[i];
  return sum;
}

void scale(float* values, uint32_t count, float by) noexcept {
  for (uint32_t i = 0; i < count; ++i) values[i] *= by;
}

}  // namespace

void ForceLimiter::set(const ForceSetup& setup) noexcept {
  axes_ = setup.axis_count;
  peak_n_ = setup.peak_n;
  step_n_ = setup.slew_n_per_s / setup.rate_hz;
  rms_.set(setup.continuous_n, kContinuousWindowS * setup.rate_hz);
  for (uint32_t i = 0; i < axes_; ++i) {
    axis_peak_n_[i] = setup.axes[i].peak_n;
    axis_rms_[i].set(setup.axes[i].continuous_n, kContinuousWindowS * setup.rate_hz);
    last_n_[i] = 0;
  }
}

void ForceLimiter::limit_rms(float* force_n, uint32_t& flags) noexcept {
  const float norm_n = __builtin_sqrtf(square_sum(force_n, axes_));
  const float limited_n = rms_.limit(norm_n, flags);
  const float share = norm_n > 0 ? limited_n / norm_n : 1;
  for (uint32_t i = 0; i < axes_; ++i) {
    const float of_axis_n = axis_rms_[i].limit(force_n[i], flags), of_vector_n = share * force_n[i];
    const bool axis_is_less = of_axis_n * of_axis_n < of_vector_n * of_vector_n;
    force_n[i] = axis_is_less ? of_axis_n : of_vector_n;
  }
}

void ForceLimiter::limit_peak(float* force_n, uint32_t& flags) const noexcept {
  for (uint32_t i = 0; i < axes_; ++i) {
    const float peak_n = axis_peak_n_[i], f = force_n[i];
    force_n[i] = f > peak_n ? peak_n : f < -peak_n ? -peak_n : f;
    if (force_n[i] != f) flags |= wire::kTickAmplitudeLimited;
  }
  const float square = square_sum(force_n, axes_);
  if (square <= peak_n_ * peak_n_) return;
  flags |= wire::kTickAmplitudeLimited;
  scale(force_n, axes_, peak_n_ / __builtin_sqrtf(square));
}

void ForceLimiter::limit_change(float* force_n, uint32_t& flags) noexcept {
  float farthest_n = 0;
  for (uint32_t i = 0; i < axes_; ++i) {
    const float change_n = force_n[i] > last_n_[i] ? force_n[i] - last_n_[i] : last_n_[i] - force_n[i];
    farthest_n = change_n > farthest_n ? change_n : farthest_n;
  }
  const bool slow = farthest_n > step_n_;
  if (slow) flags |= wire::kTickSlewLimited;
  const float share = slow ? step_n_ / farthest_n : 1;
  for (uint32_t i = 0; i < axes_; ++i) {
    const float between_n = slow ? last_n_[i] + share * (force_n[i] - last_n_[i]) : force_n[i];
    const float peak_n = axis_peak_n_[i];
    last_n_[i] = between_n > peak_n ? peak_n : between_n < -peak_n ? -peak_n : between_n;
    force_n[i] = last_n_[i];
  }
}

void ForceLimiter::limit(float* force_n, uint32_t& flags) noexcept {
  limit_peak(force_n, flags);
  limit_rms(force_n, flags);
  limit_change(force_n, flags);
}

bool ForceLimiter::at_rest() const noexcept {
  return square_sum(last_n_, axes_) == 0;
}

}  // namespace tacto::core
