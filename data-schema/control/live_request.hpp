// SPDX-License-Identifier: GPL-3.0-or-later
// The messages that the page of `tactograph live` sends to its server, one JSON object each. Answers and
// errors are those of the control protocol (control.hpp).
#pragma once

#include <cstdint>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// begin: from now on the page sends the log of a playback of this texture. keep: the log becomes a session.
enum class LiveVerb { begin, keep };

struct LiveRequest {
  LiveVerb verb = LiveVerb::keep;
  std::size_t made = 0;  ///< begin: the number of the prepared texture
};

/// Errors: malformed, naming the member, also an unknown one.
Result<LiveRequest> parse_live_request(std::string_view text);

}  // namespace tacto::schema
