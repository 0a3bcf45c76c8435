// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/format_version.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

namespace tacto::schema {
namespace {

struct Version {
  int major = 0, minor = 0;
};

std::optional<Version> version_from(std::string_view text) {
  Version version;
  const char* const end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.major);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
  if (minor.ec != std::errc() || minor.ptr != end) return std::nullopt;
  return version;
}

}  // namespace

Result<std::string> newer_version(const std::string& version, const std::string& file,
                                  const std::string& place) {
  const auto found = version_from(version);
  if (!found) return fail(ErrorKind::malformed, "`version` is not \"major.minor\"", place);
  const Version ours = *version_from(kFormatVersion);
  if (found->major != ours.major)
    return fail(ErrorKind::unsupported_version,
                fmt::format("its format has version {}, this program reads {}.x", version, ours.major), file,
                found->major > ours.major ? "use a newer tactograph" : "");
  return found->minor > ours.minor ? version : "";
}

}  // namespace tacto::schema
