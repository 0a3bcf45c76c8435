// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/kinds/file_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "data-schema/files/files.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/named_document.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/volume/volume.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<std::string_view, 21> kNames = {
    "recording",  "texture", "transducer", "spectrogram",  "formants", "descriptions", "calibration",
    "scene",      "session", "results",    "trade",        "device",   "hand",         "session_table",
    "height_map", "corpus",  "protocol",   "protocol_key", "wiring",   "mesh",         "volume"};

struct Ending {
  FileKind kind;
  std::string_view text;
};

constexpr Ending kEndings[] = {
    {FileKind::recording, ".json"},
    {FileKind::texture, ".texture.json"},
    {FileKind::transducer, ".transducer.json"},
    {FileKind::spectrogram, ".nc"},
    {FileKind::height_map, ".height.nc"},
    {FileKind::mesh, ".mesh.nc"},
    {FileKind::volume, ".volume.nc"},
    {FileKind::formants, ".formants.json"},
    {FileKind::descriptions, ".descriptions.json"},
    {FileKind::calibration, ".calibration.json"},
    {FileKind::scene, ".scene.json"},
    {FileKind::session, ".session"},
    {FileKind::results, ".results.json"},
    {FileKind::trade, ".trade.json"},
    {FileKind::device, ".device.json"},
    {FileKind::hand, ".hand.json"},
    {FileKind::corpus, ".corpus.json"},
    {FileKind::protocol, ".protocol.json"},
    {FileKind::protocol_key, ".key.json"},
    {FileKind::wiring, ".wiring.json"},
};

// What comes with tactograph under a name.
constexpr FileKind kPresetKinds[] = {FileKind::transducer, FileKind::device, FileKind::hand};

Result<StoredFile> by_content(const std::string& path) {
  const auto name = kind_of(path);
  TACTO_TRY(name);
  const auto found = std::ranges::find(kNames, *name);
  if (found == kNames.end())
    return fail(ErrorKind::malformed,
                fmt::format("has the kind '{}', which this program does not support", *name), path,
                fmt::format("the kinds are {}", fmt::join(kNames, ", ")));
  return StoredFile{static_cast<FileKind>(found - kNames.begin()), path};
}

// A file that cannot be read is treated as a spectrogram: reading it reports the error.
FileKind netcdf_kind(const std::string& path) {
  if (is_height_map(path)) return FileKind::height_map;
  if (is_mesh(path)) return FileKind::mesh;
  if (is_volume(path)) return FileKind::volume;
  return is_session_netcdf(path) ? FileKind::session_table : FileKind::spectrogram;
}

// "oak.wav" stands for "oak.json", "oak.texture.wav" for "oak.texture.json".
Result<StoredFile> by_wav(const std::string& path) {
  const std::string sidecar = path.substr(0, path.size() - 4) + ".json";
  if (is_file(sidecar)) return by_content(sidecar);
  return fail(ErrorKind::not_found, fmt::format("has no sidecar {}", sidecar), path,
              "'tactograph import' converts a sound file of another program to a recording");
}

Result<StoredFile> named_in_full(const std::string& path) {
  if (path.ends_with(".nc")) return StoredFile{netcdf_kind(path), path};
  if (path.ends_with(".session")) return StoredFile{FileKind::session, path};
  if (path.ends_with(".wav")) return by_wav(path);
  if (path.ends_with(".json")) return by_content(path);
  return fail(ErrorKind::malformed, "is not a file of tactograph", path,
              "names of its files end in .json, .wav, .nc or .session");
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

std::vector<StoredFile> presets_named(const std::string& name) {
  std::vector<StoredFile> files;
  for (const FileKind kind : kPresetKinds) {
    const auto presets = preset_names(kind_name(kind));
    if (std::ranges::find(presets, name) != presets.end()) files.push_back({kind, name});
  }
  return files;
}

}  // namespace

std::string_view kind_name(FileKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

bool has_ending_of_kind(const std::string& path) {
  return std::ranges::any_of(kEndings, [&](const auto& each) {
    return each.kind != FileKind::recording && path.ends_with(each.text);
  });
}

Result<std::vector<StoredFile>> stored_files(const std::string& name) {
  if (is_file(name))
    return named_in_full(name).map([](StoredFile file) { return std::vector{std::move(file)}; });
  if (auto files = under_stem(name); !files.empty()) return files;
  if (auto presets = presets_named(name); !presets.empty()) return presets;
  if (is_file(name + ".events.jsonl"))
    return fail(ErrorKind::unsuitable, "is not closed, or is still being recorded", name,
                fmt::format("'tactograph recover {}' makes a recording of the existing files", name));
  std::error_code why;
  if (std::filesystem::is_directory(name, why))
    return fail(ErrorKind::not_found, "is a folder, not a file", name, "name a file in it");
  if (why == std::errc::permission_denied)
    return fail(ErrorKind::not_found, "cannot be read: " + why.message(), name,
                "check its folder's permissions");
  return fail(ErrorKind::not_found, "there is no such file", name,
              "give the full name of a file, or its stem");
}

}  // namespace tacto::schema
