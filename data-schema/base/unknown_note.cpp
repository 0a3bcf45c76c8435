// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/unknown_note.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tacto::schema {
namespace {

// A damaged or foreign file may have thousands of them.
std::string names_of(const std::vector<std::string>& members) {
  constexpr std::size_t kMost = 10;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(members.size(), kMost));
  const std::string names = fmt::format("{}", fmt::join(members.begin(), members.begin() + shown, ", "));
  return members.size() <= kMost ? names : fmt::format("{} and {} more", names, members.size() - kMost);
}

std::string newer_words(const std::string& version) {
  return fmt::format(": its version {} is newer than this program's", version);
}

}  // namespace

bool is_note_on(const std::string& note, const std::string& file, const std::string& newer_version) {
  const auto named = note.find(newer_words(newer_version));
  return named != std::string::npos && file.starts_with(note.substr(0, named)) &&
         (file.size() == named || file[named] == '.');
}

std::string unknown_note(const std::string& path, const std::string& newer_version,
                         const std::vector<std::string>& unknown_members) {
  const std::string names = unknown_members.empty() ? "" : ": " + names_of(unknown_members);
  if (!newer_version.empty())
    return fmt::format("{}{}; unknown members are ignored{}", path, newer_words(newer_version), names);
  return names.empty() ? "" : fmt::format("{}: unknown members are ignored{}", path, names);
}

}  // namespace tacto::schema
