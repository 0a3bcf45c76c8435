// SPDX-License-Identifier: GPL-3.0-or-later
// Stores a fuzzer's input as a file in a folder of this process, in memory if possible.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

namespace tacto::tests {

inline void demand(bool holds) {
  if (!holds) std::abort();
}

/// The emptied folder; the same one in each call.
inline const std::filesystem::path& fuzz_folder() {
  static const std::filesystem::path folder = [] {
    const bool in_memory = std::filesystem::is_directory("/dev/shm");
    return (in_memory ? "/dev/shm" : std::filesystem::temp_directory_path()) /
           ("tacto-fuzz-" + std::to_string(getpid()));
  }();
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  demand(std::filesystem::create_directories(folder));
  return folder;
}

/// Writes the bytes as `name` into the emptied folder and returns the path.
inline std::string fuzzed_file(const std::string& name, const std::uint8_t* data, std::size_t size) {
  const std::string path = (fuzz_folder() / name).string();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  demand(file.good());
  return path;
}

}  // namespace tacto::tests
