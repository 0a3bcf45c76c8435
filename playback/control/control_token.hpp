// SPDX-License-Identifier: GPL-3.0-or-later
// What a client over TCP has to know: anybody on the machine may connect there.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::playback {

/// The first line of a file that its owner alone may read: 16 to 200 characters without blanks. Errors:
/// not_found; unsuitable: others may read it too, or it is too short; each with what to do.
schema::Result<std::string> read_control_token(const std::string& path);

/// Takes as long wherever the two begin to differ.
bool is_token(std::string_view said, std::string_view token);

/// How long the answer to a wrong token waits: a second, after ten of them within a minute.
class WrongTokens {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// One more came at `now`.
  std::chrono::seconds wait_of(Time now);

 private:
  std::deque<Time> newest_;  // ten at most
};

}  // namespace tacto::playback
