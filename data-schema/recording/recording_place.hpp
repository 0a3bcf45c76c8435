// SPDX-License-Identifier: GPL-3.0-or-later
// Checks before a recording is begun. Internal to this folder.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// The file of the events of a recording in progress.
std::string events_path(const std::string& stem);

/// The stem of such a file, or of any other file of a recording.
std::string recording_stem_of(const std::string& name);

/// Checks that no file of a recording with this stem exists. Errors: usage, naming the file.
Result<void> check_free(const std::string& stem);

/// Checks that the header can be stored, before the first sample. Errors: unsuitable, by JSON pointer.
Result<void> check_storable(const RecordingHeader& header);

/// Sets checksum, date and creator for the samples in `wav`, and returns the sidecar's text. Errors:
/// not_found; unsuitable.
Result<std::string> completed_sidecar(RecordingHeader& header, const std::string& wav);

}  // namespace tacto::schema
