// SPDX-License-Identifier: GPL-3.0-or-later
// The token of clients over TCP, to which any user of the machine may connect.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::playback {

/// The first line of a file that only its owner may read: 16 to 200 characters without blanks. Errors:
/// not_found; unsuitable: others may read it too, or it is too short; each with what to do.
schema::Result<std::string> read_control_token(const std::string& path);

/// Compares in a time that does not depend on the first difference.
bool is_token(std::string_view said, std::string_view token);

/// The delay of the answer to a wrong token: a second, after ten of them within a minute.
class WrongTokens {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// Records a wrong token at `now` and returns the delay.
  std::chrono::seconds wait_of(Time now);

 private:
  std::deque<Time> newest_;  // at most ten
};

}  // namespace tacto::playback
