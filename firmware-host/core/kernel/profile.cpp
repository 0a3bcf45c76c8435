// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/kernel/profile.hpp"

#include "firmware-host/core/kernel/counts_between.hpp"

namespace tacto::core {
namespace {

constexpr int32_t kFarthestSample = INT32_C(1) << 29;
constexpr float kPerFraction = 1.0F / (1 << 24);
constexpr float kFractions = 1 << 24;
constexpr int64_t kOneSample = INT64_C(1) << 32;

// index modulo size, never negative.
int32_t wrapped(int32_t index, int32_t size) noexcept {
  const int32_t rest = index % size;
  return rest < 0 ? rest + size : rest;
}

// step x fraction / 2^32 without overflow of the 96-bit product.
int64_t part_of(uint64_t step, uint32_t fraction) noexcept {
  return static_cast<int64_t>((step >> 32) * fraction + (((step & 0xFFFFFFFFU) * fraction) >> 32));
}

// offset x 2^24, rounded toward zero. One instruction with 64-bit registers; otherwise in two parts with the
// same bits.
int64_t in_fractions(float offset) noexcept {
  if constexpr (sizeof(void*) >= sizeof(int64_t)) return static_cast<int64_t>(offset * kFractions);
  const auto whole = static_cast<int32_t>(offset);
  const auto rest = static_cast<int32_t>((offset - static_cast<float>(whole)) * kFractions);
  return whole * INT64_C(0x1000000) + rest;
}

// step x offset, with a resolution of 2^-24 of a step.
int64_t step_times(uint64_t step, float offset) noexcept {
  const int64_t fractions = in_fractions(offset);
  return static_cast<int64_t>(step) * (fractions >> 24) +
         part_of(step, static_cast<uint32_t>(fractions) << 8);
}

// The place within one period; divides only if the place is outside of it.
int64_t within_period(int64_t place, int32_t size) noexcept {
  const auto sample = static_cast<int32_t>(place >> 32);
  if (sample >= 0 && sample < size) return place;
  return static_cast<int64_t>(wrapped(sample, size)) * kOneSample + static_cast<uint32_t>(place);
}

}  // namespace

int32_t reach_counts(const ProfileScale& scale) noexcept {
  return kFarthestSample / (static_cast<int32_t>(scale.samples_per_count_q32 >> 32) + 1);
}

uint32_t level_samples(const ProfileScale& scale, uint32_t level) noexcept {
  if (scale.ends == wire::ProfileEnds::loop) return scale.samples >> (level / 2);
  return ((scale.samples - 1) >> (level / 2)) + 1;
}

uint32_t pyramid_samples(const ProfileScale& scale) noexcept {
  uint32_t samples = 0;
  for (uint8_t level = 0; level < scale.levels; ++level) samples += level_samples(scale, level);
  return samples;
}

Profile::Profile(const float* samples, const ProfileScale& scale) noexcept
    : scale_(scale), reach_(reach_counts(scale)), farthest_(static_cast<float>(reach_)) {
  for (uint8_t i = 0; i < scale.levels; ++i) {
    levels_[i] = {samples, static_cast<int32_t>(level_samples(scale, i))};
    samples += levels_[i].size;
  }
}

// One division for all samples.
void Profile::gather(const Level& level, int32_t first, float* y) const noexcept {
  const int32_t size = level.size;
  if (scale_.ends == wire::ProfileEnds::stop) {
    for (int32_t i = 0; i < kReach; ++i)
      y[i] = first + i >= 0 && first + i < size ? level.samples[first + i] : 0;
    return;
  }
  const int32_t period = scale_.ends == wire::ProfileEnds::loop ? size : 2 * (size - 1);
  int32_t at = wrapped(first, period);
  for (int32_t i = 0; i < kReach; ++i) {
    y[i] = level.samples[at < size ? at : period - at];
    at = at + 1 < period ? at + 1 : 0;
  }
}

Float4 Profile::read_near_end(const Level& level, int32_t first, float u) const noexcept {
  float y[kReach];
  gather(level, first, y);
  return weighted(scale_.interpolation, y, u);
}

Float4 Profile::read(uint32_t which, int64_t place) const noexcept {
  const Level& level = levels_[which];
  place >>= which / 2;
  const int32_t first = static_cast<int32_t>(place >> 32) - kBefore;
  const auto fraction = static_cast<int32_t>(static_cast<uint32_t>(place) >> 8);
  const float u = static_cast<float>(fraction) * kPerFraction;
  const bool inside = first >= 0 && first + kReach <= level.size;
  return inside ? weighted(scale_.interpolation, level.samples + first, u) : read_near_end(level, first, u);
}

// Reduces the count to a loop's first period before the offset is known.
bool Profile::place_of(int32_t count, float offset, int64_t& place) const noexcept {
  const int64_t away = counts_between(scale_.origin_count, count);
  if (away > reach_ || away < -reach_) return false;
  if (!(offset >= -farthest_ && offset <= farthest_)) return false;
  place = away * static_cast<int64_t>(scale_.samples_per_count_q32) + scale_.at_origin_q32;
  const bool looped = scale_.ends == wire::ProfileEnds::loop;
  if (looped) place = within_period(place, levels_[0].size);
  place += step_times(scale_.samples_per_count_q32, offset);
  if (looped) place = within_period(place, levels_[0].size);
  return true;
}

float Profile::at(int32_t count, float offset, Detail detail) const noexcept {
  int64_t place = 0;
  if (!place_of(count, offset, place)) return 0;
  if (scale_.levels == 1 || detail.coarser == 0) return sum_of(read(0, place));
  if (detail.coarser > scale_.levels) return 0;
  const Float4 fine = read(detail.coarser - 1, place);
  const Float4 coarse = detail.coarser < scale_.levels ? read(detail.coarser, place) : Float4{};
  return sum_of(fine + detail.fade * (coarse - fine));
}

}  // namespace tacto::core
