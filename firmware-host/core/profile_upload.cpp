// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/profile_upload.hpp"

#include "firmware-host/core/finite.hpp"
#include "firmware-host/core/wire/crc32c.hpp"

namespace tacto::core {
namespace {

using wire::AnswerCode;

constexpr uint64_t kMostSamplesPerCount = UINT64_C(1024) << 32;
constexpr int64_t kFarthestOrigin = INT64_C(1) << 61;

enum Field : uint32_t { kAtOrigin = 2, kSamplesPerCount = 3, kEnds = 4 };

bool sound(const wire::ProfileBegin& message, uint32_t& field) noexcept {
  const bool near = message.at_origin_q32 > -kFarthestOrigin && message.at_origin_q32 < kFarthestOrigin;
  const bool dense =
      message.samples_per_count_q32 > 0 && message.samples_per_count_q32 <= kMostSamplesPerCount;
  field = !near ? kAtOrigin : !dense ? kSamplesPerCount : kEnds;
  return near && dense && message.ends <= wire::ProfileEnds::mirror;
}

}  // namespace

Reply ProfileUpload::begin(const wire::ProfileBegin& message, const wire::Texture& texture) noexcept {
  forget();
  uint32_t field = 0;
  if (message.samples > capacity_) return {AnswerCode::too_large, capacity_};
  if (message.samples < kLeastProfile) return {AnswerCode::bad_value, 0};
  if (!sound(message, field)) return {AnswerCode::bad_value, field};
  const ProfileScale scale{
      message.samples, message.origin_count, message.at_origin_q32, message.samples_per_count_q32,
      message.ends,    texture.levels,       texture.interpolation};
  if (level_samples(scale, static_cast<uint8_t>(scale.levels - 1)) < kLeastProfile)
    return {AnswerCode::bad_value, 0};
  if (pyramid_samples(scale) > capacity_) return {AnswerCode::too_large, capacity_};
  scale_ = scale;
  total_ = pyramid_samples(scale);
  return {};
}

Reply ProfileUpload::chunk(const wire::ProfileChunk& message) noexcept {
  if (message.first > here_) return {AnswerCode::incomplete, here_};
  if (message.count > total_ - message.first) return {AnswerCode::too_large, total_};
  complete_ = false;
  for (uint32_t i = 0; i < message.count; ++i) {
    if (!is_finite(message.values[i])) return {AnswerCode::bad_value, message.first + i};
    memory_[message.first + i] = message.values[i];
  }
  const uint32_t end = message.first + message.count;
  here_ = end > here_ ? end : here_;
  return {};
}

uint32_t ProfileUpload::check() const noexcept {
  uint32_t check = 0;
  for (uint32_t i = 0; i < total_; ++i) {
    uint8_t bytes[4];
    wire::FieldWriter(bytes, sizeof bytes)(memory_[i]);
    check = wire::crc32c(bytes, sizeof bytes, check);
  }
  return check;
}

Reply ProfileUpload::end(const wire::ProfileEnd& message) noexcept {
  if (total_ == 0 || here_ < total_) return {AnswerCode::incomplete, here_};
  const uint32_t is = check();
  complete_ = is == message.check;
  return complete_ ? Reply{} : Reply{AnswerCode::check_failed, is};
}

}  // namespace tacto::core
