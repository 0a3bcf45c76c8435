// SPDX-License-Identifier: GPL-3.0-or-later
// A folder for files that nobody keeps.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// Made under the system's folder for temporary files; gone with this object, and all that is in it.
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
