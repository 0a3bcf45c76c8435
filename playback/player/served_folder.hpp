// SPDX-License-Identifier: GPL-3.0-or-later
// The only folder from which clients over TCP may load.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::playback {

/// The path of a texture or scene in `folder`, with all its files: no absolute name, no `..`, no link to the
/// outside. Errors: not_found, the same for a missing file and for one elsewhere, so that a client cannot
/// find out over TCP which files exist; unsuitable: no folder is configured.
schema::Result<std::string> served_file(const std::string& folder, const std::string& file);

}  // namespace tacto::playback
