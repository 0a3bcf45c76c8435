// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/kinds/file_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<std::string_view, 12> kNames = {
    "recording",   "texture", "transducer", "spectrogram", "formants", "descriptions",
    "calibration", "scene",   "session",    "results",     "trade",    "session_table"};

struct Ending {
  FileKind kind;
  std::string_view text;
};

constexpr Ending kEndings[] = {
    {FileKind::recording, ".json"},
    {FileKind::texture, ".texture.json"},
    {FileKind::transducer, ".transducer.json"},
    {FileKind::spectrogram, ".nc"},
    {FileKind::formants, ".formants.json"},
    {FileKind::descriptions, ".descriptions.json"},
    {FileKind::calibration, ".calibration.json"},
    {FileKind::scene, ".scene.json"},
    {FileKind::session, ".session"},
    {FileKind::results, ".results.json"},
    {FileKind::trade, ".trade.json"},
};

Result<StoredFile> by_content(const std::string& path) {
  const auto name = kind_of(path);
  TACTO_TRY(name);
  const auto found = std::ranges::find(kNames, *name);
  if (found == kNames.end())
    return fail(ErrorKind::malformed,
                fmt::format("is of the kind '{}', which is unknown to this program", *name), path,
                fmt::format("the kinds are {}", fmt::join(kNames, ", ")));
  return StoredFile{static_cast<FileKind>(found - kNames.begin()), path};
}

// A file that cannot be read is treated as a spectrogram: reading it reports the error.
FileKind netcdf_kind(const std::string& path) {
  return is_session_netcdf(path) ? FileKind::session_table : FileKind::spectrogram;
}

// "oak.wav" stands for "oak.json", "oak.texture.wav" for "oak.texture.json".
Result<StoredFile> by_wav(const std::string& path) {
  const std::string sidecar = path.substr(0, path.size() - 4) + ".json";
  if (is_file(sidecar)) return by_content(sidecar);
  return fail(ErrorKind::not_found, fmt::format("has no sidecar {}", sidecar), path,
              "a sound file of another program becomes a recording with 'tactograph import'");
}

Result<StoredFile> named_in_full(const std::string& path) {
  if (path.ends_with(".nc")) return StoredFile{netcdf_kind(path), path};
  if (path.ends_with(".session")) return StoredFile{FileKind::session, path};
  if (path.ends_with(".wav")) return by_wav(path);
  if (path.ends_with(".json")) return by_content(path);
  return fail(ErrorKind::malformed, "is no file of tactograph", path,
              "its files end in .json, .wav, .nc or .session");
}

std::vector<StoredFile> under_stem(const std::string& stem) {
  std::vector<StoredFile> files;
  for (const auto& [kind, ending] : kEndings)
    if (const std::string path = stem + std::string(ending); kind == FileKind::spectrogram && is_file(path))
      files.push_back({netcdf_kind(path), path});
    else if (is_file(path))
      // The stem may itself end in ".texture"; a file without a readable kind has the kind of its name.
      files.push_back(kind == FileKind::recording ? by_content(path).value_or(StoredFile{kind, path})
                                                  : StoredFile{kind, path});
  return files;
}

}  // namespace

std::string_view kind_name(FileKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

Result<std::vector<StoredFile>> stored_files(const std::string& name) {
  if (is_file(name))
    return named_in_full(name).map([](StoredFile file) { return std::vector{std::move(file)}; });
  if (auto files = under_stem(name); !files.empty()) return files;
  const auto presets = preset_names();
  if (std::ranges::find(presets, name) != presets.end())
    return std::vector{StoredFile{FileKind::transducer, name}};
  if (is_file(name + ".events.jsonl"))
    return fail(ErrorKind::unsuitable, "was never closed, or is still being recorded", name,
                fmt::format("'tactograph recover {}' makes a recording of what is there", name));
  return fail(ErrorKind::not_found, "there is no such file", name, "name a file in full, or by its stem");
}

}  // namespace tacto::schema
