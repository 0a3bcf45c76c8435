// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether a session's upload is complete: if the disk was full, a part may be missing.
#pragma once

#include <cstdint>
#include <string>

#include "data-schema/session/session.hpp"

namespace tacto::playback {

/// Receives all commands of a session in order.
class UploadWatch {
 public:
  /// Ignores bytes that are not a frame.
  void see(const schema::SessionCommand& command);
  /// Which parts of the data sent up to arming are missing, in words; empty if none.
  std::string missing() const;

 private:
  std::uint64_t samples_ = 0, here_ = 0;  // of the profile; of a scene bytes
  bool armed_ = false;
};

}  // namespace tacto::playback
