// SPDX-License-Identifier: GPL-3.0-or-later
// The creation date of a new file.
#pragma once

#include <string>

namespace tacto::schema {

/// The time as ISO 8601 in UTC, to the second: "2024-05-06T07:08:09Z". Where SOURCE_DATE_EPOCH is set
/// (seconds since 1970, as reproducible-builds.org defines it) that time instead, so that equal inputs give
/// equal files.
std::string creation_time();

}  // namespace tacto::schema
