// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/format_version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <mutex>
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

// Files are read by several threads.
struct Found {
  std::mutex mutex;
  std::vector<NewerVersion> versions;
};

Found& newer_found() {
  static Found all;
  return all;
}

void keep_newer(const std::string& file, const std::string& version) {
  Found& found = newer_found();
  const std::lock_guard lock(found.mutex);
  const auto same = [&](const NewerVersion& each) { return each.file == file && each.version == version; };
  if (std::ranges::none_of(found.versions, same)) found.versions.push_back({file, version});
}

}  // namespace

Result<std::string> newer_version(const std::string& version, const std::string& file,
                                  const std::string& place, std::string_view ours) {
  const auto found = version_from(version);
  if (!found) return fail(ErrorKind::malformed, "`version` is not \"major.minor\"", place);
  const Version known = *version_from(ours);
  if (found->major != known.major)
    return fail(
        ErrorKind::unsupported_version,
        fmt::format("its format has version {}, this program reads {}.x", version, known.major), file,
        found->major > known.major ? "use a newer tactograph" : "read it with the tactograph that wrote it");
  if (found->minor <= known.minor) return "";
  keep_newer(file, version);
  return version;
}

std::vector<NewerVersion> newer_versions() {
  Found& found = newer_found();
  const std::lock_guard lock(found.mutex);
  return found.versions;
}

}  // namespace tacto::schema
