// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/config_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <system_error>

namespace tacto::schema {
namespace {

std::string variable(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? "" : text;
}

}  // namespace

Result<std::filesystem::path> config_folder(const std::string& what) {
  const std::string config = variable("XDG_CONFIG_HOME"), home = variable("HOME");
  if (config.empty() && home.empty())
    return fail(ErrorKind::not_found,
                fmt::format("neither XDG_CONFIG_HOME nor HOME is set, which give the folder of {}", what), {},
                "set HOME, or give a file");
  const std::filesystem::path base =
      config.empty() ? std::filesystem::path(home) / ".config" : std::filesystem::path(config);
  return base / "tactograph";
}

Result<void> make_folder_of(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) return fail(ErrorKind::cannot_write, "cannot be created: " + failed.message(), folder.string());
  return {};
}

}  // namespace tacto::schema
