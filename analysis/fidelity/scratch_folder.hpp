// SPDX-License-Identifier: GPL-3.0-or-later
// A folder for temporary files.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Created in the system's folder for temporary files. The destructor deletes it with its contents.
class ScratchFolder {
 public:
  /// Errors: cannot_write.
  static schema::Result<ScratchFolder> make();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace tacto::analysis
