// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/scene_upload.hpp"

namespace tacto::core {

using wire::AnswerCode;

// The first part of a block begins it anew.
Reply SceneUpload::part(const wire::ScenePart& message) noexcept {
  if (message.bytes > most_bytes()) return {AnswerCode::too_large, most_bytes()};
  if (message.first == 0) {
    forget();
    bytes_ = message.bytes;
  }
  if (message.bytes != bytes_) return bad_value(0);
  if (message.first > here_) return {AnswerCode::incomplete, here_};
  if (message.count > bytes_ - message.first) return {AnswerCode::too_large, bytes_};
  complete_ = false;
  __builtin_memcpy(reinterpret_cast<uint8_t*>(memory_) + message.first, message.data, message.count);
  const uint32_t end = message.first + message.count;
  here_ = end > here_ ? end : here_;
  if (here_ < bytes_) return {};
  const SceneFault fault = read_scene_block(memory_, bytes_, view_);
  complete_ = fault == SceneFault::none;
  return complete_ ? Reply{} : Reply{AnswerCode::check_failed, static_cast<uint32_t>(fault)};
}

}  // namespace tacto::core
