// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fft_wisdom.hpp"

#include <fftw3.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>

#include "data-schema/files.hpp"

namespace tacto::spatial {
namespace {

namespace fs = std::filesystem;

struct FreeText {
  void operator()(char* text) const { fftwf_free(text); }
};

fs::path folder_named(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path folder = value == nullptr ? "" : value;
  return folder.is_absolute() ? folder : fs::path();
}

}  // namespace

std::string wisdom_path() {
  fs::path folder = folder_named("XDG_CACHE_HOME");
  if (folder.empty())
    if (const fs::path home = folder_named("HOME"); !home.empty()) folder = home / ".cache";
  return folder.empty() ? std::string() : (folder / "tactograph" / "fftwf.wisdom").string();
}

bool read_wisdom(const std::string& path) {
  if (path.empty()) return false;
  const auto text = schema::read_file(path);
  return text && fftwf_import_wisdom_from_string(text->c_str()) != 0;
}

bool write_wisdom(const std::string& path) {
  if (path.empty()) return false;
  read_wisdom(path);  // another process may have learned since
  const std::unique_ptr<char, FreeText> text(fftwf_export_wisdom_to_string());
  if (!text) return false;
  std::error_code ignored;
  fs::create_directories(fs::path(path).parent_path(), ignored);
  schema::PendingFiles files;
  return files.write(path, text.get()) && files.commit();
}

}  // namespace tacto::spatial
