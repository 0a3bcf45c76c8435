// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/spectrogram_output.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::spatial {

using schema::ErrorKind;
using schema::PendingFiles;
using schema::Result;

namespace {

constexpr std::array<std::string_view, 4> kExtensions = {".png", ".svg", ".nc", ".csv"};

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

// The table of a profile may also begin with the position, but it has no column of a spatial frequency.
bool is_spectrogram_table(std::string_view line) {
  const bool begins = line.starts_with("position_mm,") || line.starts_with("stroke,position_mm,");
  return begins && line.find("/mm,") != std::string_view::npos;
}

// An empty file may be replaced.
Result<void> check_netcdf_kind(const std::string& path) {
  std::error_code ignored;
  const auto size = std::filesystem::file_size(path, ignored);
  if (ignored || size == 0 || schema::is_spectrogram_nc(path)) return {};
  return schema::fail(ErrorKind::usage, "has other contents and is not overwritten", path,
                      "choose another name, or remove it first");
}

Result<void> check_output(const std::string& path, std::span<const std::string> earlier,
                          schema::Existing existing) {
  const std::string extension = extension_of(path);
  if (std::ranges::find(kExtensions, extension) == kExtensions.end())
    return schema::fail(ErrorKind::usage,
                        extension.empty() ? "the name has no extension, which selects the format"
                                          : "'" + extension + "' is not a format for spectrograms",
                        path, "use .png, .svg, .nc or .csv");
  if (std::ranges::any_of(earlier, [&](const std::string& other) { return schema::same_file(path, other); }))
    return schema::fail(ErrorKind::usage, "is named twice", path, "give each output a name of its own");
  if (extension == ".csv") return schema::check_table_free(path, existing, is_spectrogram_table);
  if (extension == ".nc")
    if (auto ours = check_netcdf_kind(path); !ours) return ours;
  return schema::check_output_free(path, existing);
}

}  // namespace

OutputForm form_of(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".nc") return OutputForm::netcdf;
  return extension == ".csv" ? OutputForm::table : OutputForm::picture;
}

Result<void> check_outputs(std::span<const std::string> paths, schema::Existing existing) {
  PendingFiles trial;  // never committed: only tests that the folders are writable
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (auto checked = check_output(paths[i], paths.first(i), existing); !checked) return checked;
    TACTO_TRY(trial.add(paths[i]));
  }
  return {};
}

}  // namespace tacto::spatial
