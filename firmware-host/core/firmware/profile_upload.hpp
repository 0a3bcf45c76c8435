// SPDX-License-Identifier: Apache-2.0
// Receives a profile chunk by chunk.
#pragma once

#include "firmware-host/core/kernel/profile.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

inline constexpr uint32_t kLeastProfile = 6;  ///< samples: the number that one interpolation reads

/// An answer to a command, with its detail.
struct Reply {
  wire::AnswerCode code = wire::AnswerCode::ok;
  uint32_t detail = 0;
};

/// `field` is the index of the field in its message.
inline Reply bad_value(uint32_t field) noexcept {
  return {wire::AnswerCode::bad_value, field};
}

/// Stores the samples in memory of the board. Chunks come in order; a repeated chunk is written again. Only a
/// profile with the right check can be armed. The check is computed chunk by chunk: no call takes longer than
/// one chunk needs, unless a chunk was repeated. For the main loop.
class ProfileUpload {
 public:
  ProfileUpload(float* memory, uint32_t capacity) noexcept : memory_(memory), capacity_(capacity) {}

  /// Uses all of the memory.
  Reply begin(const wire::ProfileBegin& message) noexcept;
  /// Uses the memory that another upload leaves free, from its other end, so that the free memory is always
  /// in one piece.
  Reply begin_beside(const ProfileUpload& other, const wire::ProfileBegin& message) noexcept;
  /// After begin(): the samples consist of this number of levels.
  Reply levels(const wire::ProfileLevels& message) noexcept;
  Reply chunk(const wire::ProfileChunk& message) noexcept;
  Reply end(const wire::ProfileEnd& message) noexcept;
  void forget() noexcept;

  bool begun() const noexcept { return samples_ > 0; }
  bool complete() const noexcept { return complete_; }
  uint32_t here() const noexcept { return here_; }
  uint32_t capacity() const noexcept { return capacity_; }
  Profile profile() const noexcept { return {memory_ + place_, scale_}; }

 private:
  Reply begin_within(uint32_t room, const wire::ProfileBegin& message) noexcept;
  void check_up_to(uint32_t end) noexcept;

  float* memory_;
  uint32_t capacity_;
  ProfileScale scale_;
  uint32_t place_ = 0;    // of the first sample in the memory
  uint32_t samples_ = 0;  // of all levels
  uint32_t here_ = 0;
  uint32_t checked_ = 0, check_ = 0;  // number of samples in the check so far, and the check
  bool complete_ = false;
};

}  // namespace tacto::core
