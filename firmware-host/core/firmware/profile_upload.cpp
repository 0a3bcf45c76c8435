// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/profile_upload.hpp"

#include "firmware-host/core/kernel/finite.hpp"
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

void ProfileUpload::forget() noexcept {
  *this = ProfileUpload(memory_, capacity_);
}

Reply ProfileUpload::begin(const wire::ProfileBegin& message) noexcept {
  forget();
  return begin_within(capacity_, message);
}

Reply ProfileUpload::begin_beside(const ProfileUpload& other, const wire::ProfileBegin& message) noexcept {
  forget();
  const bool at_start = other.place_ > 0;
  const Reply reply = begin_within(at_start ? other.place_ : capacity_ - other.samples_, message);
  if (reply.code == AnswerCode::ok && !at_start) place_ = capacity_ - samples_;
  return reply;
}

Reply ProfileUpload::begin_within(uint32_t room, const wire::ProfileBegin& message) noexcept {
  uint32_t field = 0;
  if (message.samples > room) return {AnswerCode::too_large, room};
  if (message.samples < kLeastProfile) return {AnswerCode::bad_value, 0};
  if (!sound(message, field)) return {AnswerCode::bad_value, field};
  scale_ = {message.samples, message.origin_count, message.at_origin_q32, message.samples_per_count_q32,
            message.ends};
  samples_ = message.samples;
  return {};
}

// The last level has the fewest samples, so that only its number of samples is tested.
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
  if (samples_ == 0 || message.first > here_) return {AnswerCode::incomplete, here_};
  if (message.count > samples_ - message.first) return {AnswerCode::too_large, samples_};
  complete_ = false;
  if (message.first < checked_) checked_ = check_ = 0;
  float* const to = memory_ + place_ + message.first;
  for (uint32_t i = 0; i < message.count; ++i) {
    if (!is_finite(message.values[i])) return {AnswerCode::bad_value, message.first + i};
    to[i] = message.values[i];
  }
  const uint32_t end = message.first + message.count;
  here_ = end > here_ ? end : here_;
  if (message.first == checked_) check_up_to(end);
  return {};
}

void ProfileUpload::check_up_to(uint32_t end) noexcept {
  for (; checked_ < end; ++checked_) {
    uint8_t bytes[4];
    wire::FieldWriter(bytes, sizeof bytes)(memory_[place_ + checked_]);
    check_ = wire::crc32c(bytes, sizeof bytes, check_);
  }
}

Reply ProfileUpload::end(const wire::ProfileEnd& message) noexcept {
  if (samples_ == 0 || here_ < samples_) return {AnswerCode::incomplete, here_};
  check_up_to(samples_);
  complete_ = check_ == message.check;
  return complete_ ? Reply{} : Reply{AnswerCode::check_failed, check_};
}

}  // namespace tacto::core
