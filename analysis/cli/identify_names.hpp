// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the names of the files that identify writes.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Errors: usage: the transducer file has no name (the message suggests one, made from the name of the
/// results or the picture), or two of the three names are the same file.
schema::Result<void> check_named(const std::string& stem, const std::string& results,
                                 const std::string& picture);

}  // namespace tacto::analysis
