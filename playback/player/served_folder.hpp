// SPDX-License-Identifier: GPL-3.0-or-later
// The one folder from which clients over TCP load.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::playback {

/// The path of a texture or scene that lies in `folder`, with all files that belong to it: no absolute name,
/// no `..`, no link that leads out. Errors: not_found, one and the same for what is missing and for what lies
/// elsewhere, so that nobody learns over TCP which files there are; unsuitable: no folder is configured.
schema::Result<std::string> served_file(const std::string& folder, const std::string& file);

}  // namespace tacto::playback
