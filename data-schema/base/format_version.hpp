// SPDX-License-Identifier: GPL-3.0-or-later
// The version of every kind of file, and what is done with a file of another one.
#pragma once

#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// "major.minor". A minor version only adds members.
inline constexpr std::string_view kFormatVersion = "1.0";

/// The version of a file if its minor version is newer than this program's, else "". Errors: malformed, with
/// `place`, if it is not "major.minor"; unsupported_version, with `file`, naming both versions, if the major
/// version differs.
Result<std::string> newer_version(const std::string& version, const std::string& file,
                                  const std::string& place);

}  // namespace tacto::schema
