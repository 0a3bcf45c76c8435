// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a session's upload is all there: a disk that was full while it was sent may have taken a part.
#pragma once

#include <cstdint>
#include <string>

#include "data-schema/session/session.hpp"

namespace tacto::playback {

/// Takes all commands of a session in their order.
class UploadWatch {
 public:
  /// What is no frame is passed over.
  void see(const schema::SessionCommand& command);
  /// What is not in the session of all that is sent up to arming, in words; empty where nothing is missing.
  std::string missing() const;

 private:
  std::uint64_t samples_ = 0, here_ = 0;  // of the profile
  bool armed_ = false;
};

}  // namespace tacto::playback
