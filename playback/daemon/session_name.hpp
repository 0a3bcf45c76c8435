// SPDX-License-Identifier: GPL-3.0-or-later
// What a session is called where nobody names it.
#pragma once

#include <string>

namespace tacto::playback {

/// `before` and the time in UTC, as in oak-20261122T201500Z.session; with -2 and so on where that is there.
std::string dated_session(const std::string& before);

}  // namespace tacto::playback
