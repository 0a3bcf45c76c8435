// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/open_by.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

bool is_number(const std::string& name) {
  return std::ranges::all_of(name, [](char c) { return '0' <= c && c <= '9'; });
}

// Also of devices, which std::filesystem::equivalent() refuses.
bool are_same(const std::string& one, const std::string& other) {
  struct stat a {};
  struct stat b {};
  return ::stat(one.c_str(), &a) == 0 && ::stat(other.c_str(), &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

// A process may end, and another user's may not be read: then it has no files.
bool has_open(const fs::path& process, const std::string& file) {
  std::error_code failed;
  for (fs::directory_iterator at(process / "fd", failed), end; !failed && at != end; at.increment(failed))
    if (are_same(at->path().string(), file)) return true;
  return false;
}

}  // namespace

std::string programs_with(const std::string& path, std::string_view otherwise) {
  std::string found;
  std::error_code failed;
  for (fs::directory_iterator at("/proc", failed), end; !failed && at != end; at.increment(failed)) {
    const std::string number = at->path().filename().string();
    if (!is_number(number) || number == std::to_string(getpid()) || !has_open(at->path(), path)) continue;
    std::string name;
    std::ifstream file(at->path() / "comm");
    std::getline(file, name);
    found += fmt::format("{}{} (process {})", found.empty() ? "" : ", ", name, number);
  }
  return found.empty() ? std::string(otherwise) : found;
}

}  // namespace tacto::schema
