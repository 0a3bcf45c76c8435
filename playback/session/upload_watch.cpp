// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/upload_watch.hpp"

#include <fmt/format.h>

#include "playback/session/session_board.hpp"

namespace tacto::playback {

void UploadWatch::see(const schema::SessionCommand& command) {
  if (armed_ || !is_frame(command.frame)) return;
  armed_ = static_cast<wire::MessageType>(command.frame[3]) == wire::MessageType::arm;
  if (const auto begin = message_in_frame<wire::ProfileBegin>(command.frame)) {
    samples_ = begin->samples;
    here_ = 0;
  }
  if (const auto part = message_in_frame<wire::ScenePart>(command.frame)) {
    if (part->first == 0) here_ = 0;
    samples_ = part->bytes;
    here_ += part->count;
  }
  if (const auto chunk = message_in_frame<wire::ProfileChunk>(command.frame)) here_ += chunk->count;
}

std::string UploadWatch::missing() const {
  if (samples_ == 0) return "the commands that begin an upload";
  if (here_ != samples_) return fmt::format("{} of the {} samples of its upload", samples_ - here_, samples_);
  return armed_ ? "" : "the command to arm";
}

}  // namespace tacto::playback
