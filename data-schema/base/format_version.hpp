// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the version of a file or protocol with this program's.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// "major.minor". A minor version only adds members.
inline constexpr std::string_view kFormatVersion = "1.0";

/// The version of a file, or of a protocol's other end, if its minor version is newer than `ours`, else "".
/// Each format and protocol calls it. A newer version is added to newer_versions(). Errors: malformed, with
/// `place`, if it is not "major.minor"; unsupported_version, with `file`, naming both versions, if the major
/// version differs. Thread-safe.
Result<std::string> newer_version(const std::string& version, const std::string& file,
                                  const std::string& place, std::string_view ours = kFormatVersion);

struct NewerVersion {
  std::string file, version;
};
/// Newer minor versions that this process has read, each once, in order. A command warns of all of them
/// before it ends. Thread-safe.
std::vector<NewerVersion> newer_versions();

}  // namespace tacto::schema
