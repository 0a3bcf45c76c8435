// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings that patterns such as 'raw/**/*.json' name.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

struct FoundRecordings {
  std::vector<std::string> paths;  ///< of sidecars, sorted, each once
  std::size_t others = 0;          ///< JSON files that are no recordings
};

/// Each pattern is a recording, a folder (with its subfolders), or a path with * ? [...] in names, and ** for
/// any number of folders. Names that begin with a dot, and links to folders, are skipped. A JSON file with a
/// WAV beside it counts as a recording even if it is damaged. Errors: not_found, if a pattern names no
/// recording.
schema::Result<FoundRecordings> find_recordings(const std::vector<std::string>& patterns);

}  // namespace tacto::analysis
