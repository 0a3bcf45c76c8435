// SPDX-License-Identifier: Apache-2.0
// The texture on the device: drive against encoder count, read between samples.
#pragma once

#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// Where counts lie on the samples: sample x 2^32 = (count - origin_count) samples_per_count_q32 +
/// at_origin_q32, exactly, in 64-bit integers: no position is lost in a float's 24 bits.
struct ProfileScale {
  uint32_t samples = 0;
  int32_t origin_count = 0;
  int64_t at_origin_q32 = 0;
  uint64_t samples_per_count_q32 = 0;
  wire::ProfileEnds ends = wire::ProfileEnds::stop;
};

/// Counts farther than this from the origin read zero, whatever the ends: 268 m of a 1 um grid.
int32_t reach_counts(const ProfileScale& scale) noexcept;

/// Cubic Hermite interpolation with slopes from central differences of fourth order, m_i = (8 (y_i+1 - y_i-1)
/// - (y_i+2 - y_i-2)) / 12. Error for a sinusoid of spatial frequency k: at most 0.0026 w^4 + 0.0032 w^5 of
/// its amplitude for w = 2 pi k pitch up to 0.63 (ten samples a period), and 4e-7 for single precision.
/// Ends: stop: samples outside are zero; loop: sample n is sample 0; mirror: about the first and last sample.
class Profile {
 public:
  Profile() = default;
  /// At least 6 samples, which are not copied. `scale` as a ProfileUpload lets through.
  Profile(const float* samples, const ProfileScale& scale) noexcept
      : samples_(samples), scale_(scale), reach_(reach_counts(scale)) {}

  /// Safe in the tick.
  float at(int32_t count) const noexcept;

 private:
  float between(const float* y, float u) const noexcept;
  float sample(int32_t index) const noexcept;

  const float* samples_ = nullptr;
  ProfileScale scale_;
  int32_t reach_ = 0;
};

}  // namespace tacto::core
