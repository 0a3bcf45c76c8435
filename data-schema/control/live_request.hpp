// SPDX-License-Identifier: GPL-3.0-or-later
// The messages that the page of `tactograph live` sends to its server, one JSON object each. Answers and
// errors are those of the control protocol (control.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// begin: from now on the page sends the log of a playback of this texture. change: its device has the frames
/// of another one, and the log goes on with the change to it. keep: the log becomes a session. steer: this
/// page steers the daemon from now on. run: a verb of the command becomes a job; cancel: a job ends. The
/// others are the daemon's.
enum class LiveVerb {
  begin,
  change,
  keep,
  steer,
  status,
  load,
  arm,
  play,
  stop,
  disarm,
  gain,
  run,
  cancel,
  save
};

inline constexpr double kMostTimes = 1e6;  ///< magnitude of LiveRequest::times

struct LiveRequest {
  LiveVerb verb = LiveVerb::keep;
  std::size_t made = 0;                     ///< begin, change: the number of the prepared texture
  std::size_t playing = 0;                  ///< change: that of the texture with which the session began
  double times = 1;                         ///< change: factor of the samples
  std::optional<std::int64_t> id;           ///< comes back in the daemon's answer
  std::optional<std::size_t> texture;       ///< load, save: index in the folder
  std::optional<double> times_default;      ///< gain
  std::string job_verb = {};                ///< run: compare, fidelity, trade, report
  std::vector<std::size_t> files = {};      ///< run: indices in the folder, at most 2
  std::size_t job = 0;                      ///< cancel
  std::optional<std::string> inverse = {};  ///< load: of the transducer, as in PlaybackChoices
};

/// Errors: malformed, naming the member, also an unknown one.
Result<LiveRequest> parse_live_request(std::string_view text);

}  // namespace tacto::schema
