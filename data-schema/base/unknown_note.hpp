// SPDX-License-Identifier: GPL-3.0-or-later
// The warning about members of a file that this program does not know.
#pragma once

#include <string>
#include <vector>

namespace tacto::schema {

/// One sentence for a reader who uses the file nevertheless: its version, if it is newer, and the members
/// that are ignored. Empty if there is neither.
std::string unknown_note(const std::string& path, const std::string& newer_version,
                         const std::vector<std::string>& unknown_members);

/// Whether a note names the newer version of this file, by its path or stem.
bool is_note_on(const std::string& note, const std::string& file, const std::string& newer_version);

/// unknown_note() for the value that a reader returned.
template <class File>
std::string unknown_note(const std::string& path, const File& file) {
  return unknown_note(path, file.newer_version, file.unknown_members);
}

}  // namespace tacto::schema
