// SPDX-License-Identifier: GPL-3.0-or-later
// The recordings of a folder, by subject and surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

struct ListedRecording {
  std::string stem;
  schema::RecordingHeader header;
  std::optional<int> take;  ///< the number at the end of its name, as in S01_oak_2
  std::string trouble;  ///< the reason why it cannot be opened, or that it was never closed; otherwise empty
};

/// All recordings in a folder, without its subfolders, by subject, surface and date; those with trouble last,
/// by name. Files of other kinds are skipped. Errors: not_found.
schema::Result<std::vector<ListedRecording>> list_recordings(const std::string& folder);

}  // namespace tacto::capture
