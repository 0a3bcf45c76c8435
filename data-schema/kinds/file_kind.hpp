// SPDX-License-Identifier: GPL-3.0-or-later
// The stored files that a name stands for, and their kinds.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

enum class FileKind {
  recording,
  texture,
  transducer,
  spectrogram,
  formants,
  descriptions,
  calibration,
  scene,
  session,
  results,
  trade,
  device,
  hand,
  session_table,  ///< a session as netCDF
  height_map,
  corpus,  ///< the plan of a corpus
  protocol,
  protocol_key,  ///< which stimulus has which code
  wiring,        ///< which sensor is wired to which input of a card
  mesh,
  volume  ///< values on a grid in space
};

/// "recording", "texture", ... as in the files' own member `kind`.
std::string_view kind_name(FileKind kind);

/// Whether a file's name has the ending of a kind, as "oak.texture.json"; not that of a recording,
/// "oak.json".
bool has_ending_of_kind(const std::string& path);

/// A stored file. `path` is the file that contains the kind: a sidecar, a .nc, a .session; or the name of a
/// preset.
struct StoredFile {
  FileKind kind;
  std::string path;
};

/// A file named in full (a sidecar, its WAV, a .nc, a .session) gives that file; a stem gives every stored
/// file with that stem, the recording first, and never an empty list; a preset's name gives the preset.
/// Errors: not_found; malformed, if the file is not of tactograph.
Result<std::vector<StoredFile>> stored_files(const std::string& name);

}  // namespace tacto::schema
