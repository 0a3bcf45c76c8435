// SPDX-License-Identifier: GPL-3.0-or-later
// Temporary files of PendingFiles whose process was killed before it could rename or remove them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tacto::schema {

/// A temporary file that is not known to be in use.
struct Leftover {
  std::string path;
  std::string target;  ///< the name of the file that it was to become, without folder; cut off at 200 bytes
  std::uint64_t bytes = 0;
  bool ended = false;  ///< the process that wrote it has ended; false: it may run, also on another machine
};

/// The temporary name, in the same folder, for the future `path`: hidden, of this process, unique.
std::string temporary_name_for(const std::string& path);

/// All temporary files in a folder, except those of running processes. Empty for a folder that cannot be
/// read.
std::vector<Leftover> leftovers_in(const std::string& folder);

/// Those that were to become files of one name: "oak" has oak.wav, oak.json, oak-01.texture.wav ...
std::vector<Leftover> leftovers_of(const std::string& stem);

/// Removes those whose process has ended, and returns the removed ones.
std::vector<Leftover> remove_ended(const std::vector<Leftover>& leftovers);

/// Removes the leftovers of killed processes for the file `path`. Each folder is searched once a process, so
/// it is cheap for many files. Any thread.
void remove_leftovers_of_file(const std::string& path);

}  // namespace tacto::schema
