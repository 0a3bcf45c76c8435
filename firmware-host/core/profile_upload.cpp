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
enum LevelsField : uint32_t { kLevels = 0, kInterpolation = 1, kFirstSamples = 3 };

bool sound(const wire::ProfileBegin& message, uint32_t& field) noexcept {
  const bool near = message.at_origin_q32 > -kFarthestOrigin && message.at_origin_q32 < kFarthestOrigin;
  const bool dense =
      message.samples_per_count_q32 > 0 && message.samples_per_count_q32 <= kMostSamplesPerCount;
  field = !near ? kAtOrigin : !dense ? kSamplesPerCount : kEnds;
  return near && dense && message.ends <= wire::ProfileEnds::mirror;
}

}  // namespace

Reply ProfileUpload::begin(const wire::ProfileBegin& message) noexcept {
  forget();
  uint32_t field = 0;
  if (message.samples > capacity_) return {AnswerCode::too_large, capacity_};
  if (message.samples < kLeastProfile) return {AnswerCode::bad_value, 0};
  if (!sound(message, field)) return {AnswerCode::bad_value, field};
  scale_ = {message.samples, message.origin_count, message.at_origin_q32, message.samples_per_count_q32,
            message.ends};
  samples_ = message.samples;
  return {};
}

// What a level of every second sample needs, its neighbour has too.
Reply ProfileUpload::levels(const wire::ProfileLevels& message) noexcept {
  if (samples_ == 0) return {AnswerCode::incomplete, 0};
  if (message.levels < 1 || message.levels > wire::kMaxLevels) return {AnswerCode::bad_value, kLevels};
  if (message.interpolation > wire::Interpolation::sinc) return {AnswerCode::bad_value, kInterpolation};
  ProfileScale scale = scale_;
  scale.samples = message.first_samples;
  scale.levels = message.levels;
  scale.interpolation = message.interpolation;
  const bool whole = message.first_samples >= kLeastProfile && message.first_samples <= samples_ &&
                     pyramid_samples(scale) == samples_ && level_samples(scale, message.levels - 1U) > 1;
  if (!whole) return {AnswerCode::bad_value, kFirstSamples};
  scale_ = scale;
  return {};
}

Reply ProfileUpload::chunk(const wire::ProfileChunk& message) noexcept {
  if (message.first > here_) return {AnswerCode::incomplete, here_};
  if (message.count > samples_ - message.first) return {AnswerCode::too_large, samples_};
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
  for (uint32_t i = 0; i < samples_; ++i) {
    uint8_t bytes[4];
    wire::FieldWriter(bytes, sizeof bytes)(memory_[i]);
    check = wire::crc32c(bytes, sizeof bytes, check);
  }
  return check;
}

Reply ProfileUpload::end(const wire::ProfileEnd& message) noexcept {
  if (samples_ == 0 || here_ < samples_) return {AnswerCode::incomplete, here_};
  const uint32_t is = check();
  complete_ = is == message.check;
  return complete_ ? Reply{} : Reply{AnswerCode::check_failed, is};
}

}  // namespace tacto::core
