// SPDX-License-Identifier: GPL-3.0-or-later
// A file of bytes, read from beginning to end.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

class InputFile {
 public:
  /// Errors: not_found (absent, a folder, no permission).
  static schema::Result<InputFile> open(const std::string& path);

  /// Fills `bytes` up to the end of the file. Returns the number of bytes, 0 at the end. Errors: not_found
  /// (the disk failed).
  schema::Result<std::size_t> read(std::span<char> bytes);
  /// The size at opening, in bytes; 0 for a file without a size, such as a pipe.
  std::size_t size() const { return size_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::string path_;
  std::size_t size_ = 0;
};

}  // namespace tacto::capture
