// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/profile.hpp"

#include "firmware-host/core/counts_between.hpp"

namespace tacto::core {
namespace {

constexpr int32_t kFarthestSample = INT32_C(1) << 29;
constexpr float kPerFraction = 1.0F / (1 << 24);
constexpr float kFractions = 1 << 24;

// Of index by size, never negative.
int32_t wrapped(int32_t index, int32_t size) noexcept {
  const int32_t rest = index % size;
  return rest < 0 ? rest + size : rest;
}

// step x fraction / 2^32 without the product's upper 32 bits getting lost.
int64_t part_of(uint64_t step, uint32_t fraction) noexcept {
  return static_cast<int64_t>((step >> 32) * fraction + (((step & 0xFFFFFFFFU) * fraction) >> 32));
}

// step x offset, to 2^-24 of a step.
int64_t stretch(uint64_t step, float offset) noexcept {
  const auto toward_zero = static_cast<int32_t>(offset);
  const int32_t whole = toward_zero - (offset < static_cast<float>(toward_zero) ? 1 : 0);
  const auto fraction = static_cast<uint32_t>((offset - static_cast<float>(whole)) * kFractions);
  const uint32_t most = (UINT32_C(1) << 24) - 1;  // an offset just below a whole number may round up to it
  return static_cast<int64_t>(step) * whole + part_of(step, (fraction < most ? fraction : most) << 8);
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
    : scale_(scale), reach_(reach_counts(scale)) {
  for (uint8_t i = 0; i < scale.levels; ++i) {
    levels_[i] = {samples, static_cast<int32_t>(level_samples(scale, i))};
    samples += levels_[i].size;
  }
}

// One division for all of them.
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

float Profile::read(uint32_t which, int64_t place) const noexcept {
  const Level& level = levels_[which];
  place >>= which / 2;
  const auto index = static_cast<int32_t>(place >> 32);
  const float u = static_cast<float>(static_cast<uint32_t>(place) >> 8) * kPerFraction;
  int32_t first = index - kBefore;
  const auto inside = [&] { return first >= 0 && first + kReach <= level.size; };
  if (!inside() && scale_.ends == wire::ProfileEnds::loop) first = wrapped(first, level.size);
  if (inside()) return interpolated(scale_.interpolation, level.samples + first, u);
  float y[kReach];
  gather(level, first, y);
  return interpolated(scale_.interpolation, y, u);
}

bool Profile::place_of(int32_t count, float offset, int64_t& place) const noexcept {
  const int64_t away = counts_between(scale_.origin_count, count);
  if (away > reach_ || away < -reach_) return false;
  place = away * static_cast<int64_t>(scale_.samples_per_count_q32) + scale_.at_origin_q32;
  const auto reach = static_cast<float>(reach_);
  if (!(offset >= -reach && offset <= reach)) return false;
  if (offset != 0) place += stretch(scale_.samples_per_count_q32, offset);
  return true;
}

float Profile::at(int32_t count, float offset, float coarseness) const noexcept {
  int64_t place = 0;
  if (!place_of(count, offset, place)) return 0;
  if (scale_.levels == 1 || coarseness < 1) return read(0, place);
  const uint32_t most = scale_.levels;
  if (coarseness >= static_cast<float>(most + 1)) return 0;
  const auto coarser = static_cast<uint32_t>(coarseness);
  const float fade = coarseness - static_cast<float>(coarser);
  const float fine = read(coarser - 1, place), coarse = coarser < most ? read(coarser, place) : 0;
  return fine + fade * (coarse - fine);
}

}  // namespace tacto::core
