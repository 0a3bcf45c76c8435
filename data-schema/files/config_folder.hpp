// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of the user's settings.
#pragma once

#include <filesystem>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// $XDG_CONFIG_HOME/tactograph, or ~/.config/tactograph without that variable. `what` names the content for
/// the error: not_found, if neither it nor HOME is set.
Result<std::filesystem::path> config_folder(const std::string& what);

/// Makes the folder of a path. Errors: cannot_write.
Result<void> make_folder_of(const std::string& path);

}  // namespace tacto::schema
