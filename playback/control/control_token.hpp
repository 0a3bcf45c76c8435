// SPDX-License-Identifier: GPL-3.0-or-later
// The token of clients over TCP, to which any user of the machine may connect.
#pragma once

#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::playback {

/// The first line of a file that only its owner may read: 16 to 200 characters without blanks. Errors:
/// not_found; unsuitable: others may read it too, or it is too short; each with what to do.
schema::Result<std::string> read_control_token(const std::string& path);

/// Compares in a time that does not depend on the first difference.
bool is_token(std::string_view said, std::string_view token);

}  // namespace tacto::playback
