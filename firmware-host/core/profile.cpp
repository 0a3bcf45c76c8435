// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/profile.hpp"

namespace tacto::core {
namespace {

constexpr int32_t kFarthestSample = INT32_C(1) << 29;
constexpr float kTwelfth = 1.0F / 12;
constexpr float kPerFraction = 1.0F / (1 << 24);

float slope(float before2, float before, float after, float after2) noexcept {
  return (8 * (after - before) - (after2 - before2)) * kTwelfth;
}

// Of index by size, never negative.
int32_t wrapped(int32_t index, int32_t size) noexcept {
  const int32_t rest = index % size;
  return rest < 0 ? rest + size : rest;
}

}  // namespace

int32_t reach_counts(const ProfileScale& scale) noexcept {
  return kFarthestSample / (static_cast<int32_t>(scale.samples_per_count_q32 >> 32) + 1);
}

float Profile::sample(int32_t index) const noexcept {
  const auto size = static_cast<int32_t>(scale_.samples);
  if (index >= 0 && index < size) return samples_[index];
  if (scale_.ends == wire::ProfileEnds::loop) return samples_[wrapped(index, size)];
  if (scale_.ends == wire::ProfileEnds::stop) return 0;
  const int32_t there_and_back = 2 * (size - 1);
  const int32_t place = wrapped(index, there_and_back);
  return samples_[place < size ? place : there_and_back - place];
}

float Profile::between(const float* y, float u) const noexcept {
  const float m0 = slope(y[0], y[1], y[3], y[4]), m1 = slope(y[1], y[2], y[4], y[5]);
  const float rise = y[3] - y[2];
  return y[2] + u * (m0 + u * (3 * rise - 2 * m0 - m1 + u * (m0 + m1 - 2 * rise)));
}

float Profile::at(int32_t count) const noexcept {
  const int64_t away = static_cast<int64_t>(count) - scale_.origin_count;
  if (away > reach_ || away < -reach_) return 0;
  const int64_t place = away * static_cast<int64_t>(scale_.samples_per_count_q32) + scale_.at_origin_q32;
  const auto index = static_cast<int32_t>(place >> 32);
  const float u = static_cast<float>(static_cast<uint32_t>(place) >> 8) * kPerFraction;
  if (index >= 2 && index + 3 < static_cast<int32_t>(scale_.samples)) return between(samples_ + index - 2, u);
  float y[6];
  for (int32_t i = 0; i < 6; ++i) y[i] = sample(index - 2 + i);
  return between(y, u);
}

}  // namespace tacto::core
