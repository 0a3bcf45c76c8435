// SPDX-License-Identifier: Apache-2.0
// Keeps the forces of a device within its limits: of each axis, of the vector, and of the change per tick.
#pragma once

#include "firmware-host/core/kernel/energy_limiter.hpp"
#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::core {

inline constexpr uint32_t kMostAxes = wire::kMaxAxes;
using wire::AxisAlong;

/// The time window of the RMS that the continuous forces limit; our choice: device files have no thermal
/// time.
inline constexpr float kContinuousWindowS = 1;

struct ForceAxis {
  AxisAlong along = AxisAlong::x;
  float metres_per_count = 1;
  float peak_n = 0, continuous_n = 0;
};

/// All values are above 0 and finite, times not negative.
struct ForceSetup {
  ForceAxis axes[kMostAxes];
  uint32_t axis_count = 0;
  float peak_n = 0, continuous_n = 0;  ///< of the vector
  float slew_n_per_s = 0;              ///< of each axis
  float rate_hz = 1;
  float onset_s = 0, release_s = 0;  ///< of the ramps from and to zero
};

/// In this order: the peak of each axis, the peak of the vector (its direction stays), the RMS of each axis
/// and of the vector (of each axis the smaller result), the change. The change is limited along the straight
/// line from the last force, so that no step leaves the other limits. Within 2^-22 of the vector's limit,
/// exactly within an axis's.
class ForceLimiter {
 public:
  void set(const ForceSetup& setup) noexcept;
  /// `force_n` of setup.axis_count axes, finite. Sets in `flags` the limits that were active
  /// (wire::TickFlag). Safe in the tick.
  void limit(float* force_n, uint32_t& flags) noexcept;
  bool at_rest() const noexcept;

 private:
  void limit_rms(float* force_n, uint32_t& flags) noexcept;
  void limit_peak(float* force_n, uint32_t& flags) const noexcept;
  void limit_change(float* force_n, uint32_t& flags) noexcept;

  uint32_t axes_ = 0;
  float axis_peak_n_[kMostAxes] = {}, peak_n_ = 0, step_n_ = 0;
  EnergyLimiter axis_rms_[kMostAxes], rms_;
  float last_n_[kMostAxes] = {};
};

}  // namespace tacto::core
