// SPDX-License-Identifier: Apache-2.0
// The texture on the device: the target signal over the encoder count, in levels of decreasing detail,
// interpolated between samples.
#pragma once

#include "firmware-host/core/kernel/interpolation.hpp"
#include "firmware-host/core/kernel/level_of_detail.hpp"

namespace tacto::core {

/// The relation of counts to samples: sample x 2^32 = (count - origin_count) samples_per_count_q32 +
/// at_origin_q32, exactly, in 64-bit integers. The 24 bits of a float would not be sufficient.
struct ProfileScale {
  uint32_t samples = 0;  ///< of the first level
  int32_t origin_count = 0;
  int64_t at_origin_q32 = 0;
  uint64_t samples_per_count_q32 = 0;
  wire::ProfileEnds ends = wire::ProfileEnds::stop;
  uint8_t levels = 1;  ///< at most kMaxLevels
  wire::Interpolation interpolation = wire::Interpolation::hermite;
};

/// At counts farther than this from the origin the profile is zero, for all kinds of ends: 268 m of a 1 um
/// grid.
int32_t reach_counts(const ProfileScale& scale) noexcept;

/// The number of samples of a level: every second level has half as many. The first level of a loop has a
/// multiple of 2^((levels - 1) / 2) samples, with other ends one more.
uint32_t level_samples(const ProfileScale& scale, uint32_t level) noexcept;
/// Of all levels, which are stored one after the other.
uint32_t pyramid_samples(const ProfileScale& scale) noexcept;

/// A pyramid: level n contains the texture up to a spatial frequency that decreases by the square root of two
/// with each level. Ends: stop: samples outside are zero; loop: sample n is sample 0; mirror: about the first
/// and last sample. The errors of interpolation are given at weights_at().
class Profile {
 public:
  Profile() = default;
  /// At least 6 samples, which are not copied. `scale` satisfies the checks of ProfileUpload.
  Profile(const float* samples, const ProfileScale& scale) noexcept;

  /// The value of the first level at a count. Safe in the tick.
  float at(int32_t count) const noexcept { return at(count, 0, {}); }

  /// The value at count + offset with that detail: level `coarser` - 1 is cross-faded linearly into level
  /// `coarser`, and the last level into zero, so the result is continuous. A profile of one level is used at
  /// every speed. Beyond reach_counts() it is zero. Safe in the tick.
  float at(int32_t count, float offset, Detail detail) const noexcept;

 private:
  struct Level {
    const float* samples = nullptr;
    int32_t size = 0;
  };
  bool place_of(int32_t count, float offset, int64_t& place) const noexcept;
  Float4 read(uint32_t level, int64_t place) const noexcept;
  [[gnu::noinline]] Float4 read_near_end(const Level& level, int32_t first, float u) const noexcept;
  void gather(const Level& level, int32_t first, float* y) const noexcept;

  ProfileScale scale_;
  int32_t reach_ = 0;
  float farthest_ = 0;  // the same
  Level levels_[wire::kMaxLevels];
};

}  // namespace tacto::core
