// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier/fft_wisdom.hpp"

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>

#include "data-schema/files/files.hpp"
#include "spatial/dsp/fourier/fftw_parts.hpp"

namespace tacto::spatial {
namespace {

namespace fs = std::filesystem;

fs::path folder_named(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path folder = value == nullptr ? "" : value;
  return folder.is_absolute() ? folder : fs::path();
}

fs::path cache_folder() {
  if (const fs::path folder = folder_named("XDG_CACHE_HOME"); !folder.empty()) return folder;
  const fs::path home = folder_named("HOME");
  return home.empty() ? home : home / ".cache";
}

}  // namespace

template <class Real>
std::string wisdom_path() {
  const fs::path folder = cache_folder();
  return folder.empty() ? "" : (folder / "tactograph" / Fftw<Real>::kName).string() + ".wisdom";
}

template <class Real>
bool read_wisdom(const std::string& path) {
  const auto text = schema::read_file(path);
  return text && Fftw<Real>::learn(text->c_str());
}

template <class Real>
bool write_wisdom(const std::string& path) {
  if (path.empty()) return false;
  read_wisdom<Real>(path);  // another process may have added to it since
  const std::unique_ptr<char, void (*)(void*)> text(Fftw<Real>::wisdom(), Fftw<Real>::free);
  if (!text) return false;
  std::error_code ignored;
  fs::create_directories(fs::path(path).parent_path(), ignored);
  schema::PendingFiles files;
  return files.write(path, text.get()) && files.commit();
}

template std::string wisdom_path<float>();
template std::string wisdom_path<double>();
template bool read_wisdom<float>(const std::string&);
template bool read_wisdom<double>(const std::string&);
template bool write_wisdom<float>(const std::string&);
template bool write_wisdom<double>(const std::string&);

}  // namespace tacto::spatial
