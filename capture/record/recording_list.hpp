// SPDX-License-Identifier: GPL-3.0-or-later
// The recordings of a folder, by who touched what.
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
  std::optional<int> take;  ///< the number that its name ends with, as in S01_oak_2
  std::string trouble;      ///< why it can't be opened, or that it was never closed; else empty
};

/// All recordings in a folder, not in folders below it, by subject, surface and date; those in trouble last,
/// by name. Files of other kinds are passed over. Errors: not_found.
schema::Result<std::vector<ListedRecording>> list_recordings(const std::string& folder);

}  // namespace tacto::capture
