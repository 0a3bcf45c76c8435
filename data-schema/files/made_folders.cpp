// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/made_folders.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <ranges>
#include <system_error>
#include <utility>

#include "data-schema/files/event_file.hpp"
#include "data-schema/files/pending_names.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

// The innermost first.
std::vector<std::string> missing_folders(const std::string& path) {
  std::vector<std::string> missing;
  for (std::string at = folder_of(path); !is_folder(at) && at != folder_of(at); at = folder_of(at))
    missing.push_back(at);
  return missing;
}

}  // namespace

MadeFolders& MadeFolders::operator=(MadeFolders&& other) noexcept {
  std::swap(made_, other.made_);
  return *this;
}

// One that is not empty stays.
MadeFolders::~MadeFolders() {
  for (PendingName* name : made_ | std::views::reverse) {
    rmdir(name->path.c_str());
    pending_names().forget(name);
  }
}

Result<void> MadeFolders::make_for(const std::string& path) {
  for (const std::string& folder : missing_folders(path) | std::views::reverse) {
    std::error_code failed;
    if (fs::create_directory(folder, failed)) {
      made_.push_back(pending_names().keep(folder));
      TACTO_TRY(sync_path(folder_of(folder)));
    }
    if (failed == std::errc::file_exists || failed == std::errc::not_a_directory)
      return fail(ErrorKind::cannot_write, "is a file, not a folder", folder, "choose another folder");
    if (!is_folder(folder))
      return fail(ErrorKind::cannot_write, "the folder cannot be made: " + failed.message(), folder,
                  "choose another folder");
  }
  return {};
}

std::string existing_folder_of(const std::string& path) {
  const auto missing = missing_folders(path);
  return missing.empty() ? folder_of(path) : folder_of(missing.back());
}

}  // namespace tacto::schema
