// SPDX-License-Identifier: GPL-3.0-or-later
// What a client over TCP has to know: anybody on the machine may connect there.
#pragma once

#include <string>
#include <string_view>

#include "data-schema/error.hpp"

namespace tacto::playback {

/// The first line of a file that its owner alone may read: 16 to 200 characters without blanks. Errors:
/// not_found; unsuitable: others may read it too, or it is too short; each with what to do.
schema::Result<std::string> read_control_token(const std::string& path);

/// Takes as long wherever the two begin to differ.
bool is_token(std::string_view said, std::string_view token);

}  // namespace tacto::playback
