// SPDX-License-Identifier: GPL-3.0-or-later
// The messages that the page of `tactograph live` sends to its server, one JSON object each. Answers and
// errors are those of the control protocol (control.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// begin: from now on the page sends the log of a playback of this texture. keep: the log becomes a session.
/// steer: this page steers the daemon from now on. The others are the daemon's.
enum class LiveVerb { begin, keep, steer, status, load, arm, play, stop, disarm, gain };

struct LiveRequest {
  LiveVerb verb = LiveVerb::keep;
  std::size_t made = 0;                 ///< begin: the number of the prepared texture
  std::optional<std::int64_t> id;       ///< comes back in the daemon's answer
  std::optional<std::size_t> texture;   ///< load: index in the folder
  std::optional<double> times_default;  ///< gain
};

/// Errors: malformed, naming the member, also an unknown one.
Result<LiveRequest> parse_live_request(std::string_view text);

}  // namespace tacto::schema
