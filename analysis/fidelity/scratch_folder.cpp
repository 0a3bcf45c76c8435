// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/fidelity/scratch_folder.hpp"

#include <stdlib.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace tacto::analysis {

namespace fs = std::filesystem;

schema::Result<ScratchFolder> ScratchFolder::make() {
  std::error_code failure;
  std::string path = (fs::temp_directory_path(failure) / "tactograph-XXXXXX").string();
  if (!failure && mkdtemp(path.data()) != nullptr) return ScratchFolder(path);
  return schema::fail(schema::ErrorKind::cannot_write, "no temporary folder can be made", path,
                      "set TMPDIR to a folder that can be written");
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace tacto::analysis
