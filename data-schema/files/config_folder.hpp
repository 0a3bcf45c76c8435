// SPDX-License-Identifier: GPL-3.0-or-later
// Where this user's settings are kept.
#pragma once

#include <filesystem>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// $XDG_CONFIG_HOME/tactograph, or ~/.config/tactograph without that variable. `what` is kept there, in words
/// for the error: not_found, where neither it nor HOME is set.
Result<std::filesystem::path> config_folder(const std::string& what);

/// Makes the folder that a path lies in. Errors: cannot_write.
Result<void> make_folder_of(const std::string& path);

}  // namespace tacto::schema
