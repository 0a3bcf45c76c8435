// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/input_file.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "data-schema/files/files.hpp"

namespace tacto::capture {

schema::Result<InputFile> InputFile::open(const std::string& path) {
  std::error_code unknown;
  const auto status = std::filesystem::status(path, unknown);
  // A pipe cannot be opened a second time, and opening one may block forever.
  if (std::filesystem::exists(status) && !is_regular_file(status) && !is_directory(status))
    return schema::fail(schema::ErrorKind::not_found, "is not a regular file", path,
                        "write it to a file first");
  TACTO_TRY(schema::check_readable(path));
  InputFile input;
  input.path_ = path;
  input.file_.reset(std::fopen(path.c_str(), "rbe"));
  if (!input.file_) return schema::fail(schema::ErrorKind::not_found, "cannot be opened", path);
  const auto size = std::filesystem::file_size(path, unknown);
  input.size_ = unknown ? 0 : size;
  return input;
}

schema::Result<std::size_t> InputFile::read(std::span<char> bytes) {
  const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), file_.get());
  if (got < bytes.size() && std::ferror(file_.get()) != 0)
    return schema::fail(schema::ErrorKind::not_found,
                        "cannot be read: " + std::generic_category().message(errno), path_);
  return got;
}

}  // namespace tacto::capture
