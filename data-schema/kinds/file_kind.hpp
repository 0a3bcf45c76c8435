// SPDX-License-Identifier: GPL-3.0-or-later
// What a name given by the user stands for: which files of ours, of which kinds.
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
  session_table  ///< a session as netCDF
};

/// "recording", "texture", ... as in the files' own member `kind`.
std::string_view kind_name(FileKind kind);

/// A file of ours. `path` is the one that says what it is: a sidecar, a .nc, a .session; a preset's name for
/// a preset.
struct StoredFile {
  FileKind kind;
  std::string path;
};

/// A file named in full (a sidecar, its WAV, a .nc, a .session) gives that one; a stem gives every file of
/// ours under it, the recording first, and never an empty list; a preset's name gives the preset. Errors:
/// not_found; malformed, where the file is none of ours.
Result<std::vector<StoredFile>> stored_files(const std::string& name);

}  // namespace tacto::schema
