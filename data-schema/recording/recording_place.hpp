// SPDX-License-Identifier: GPL-3.0-or-later
// What is checked before a recording is begun. Internal to this folder.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// Where the events of a recording are kept while it is made.
std::string events_path(const std::string& stem);

/// The stem of such a file, or of any other of a recording's.
std::string recording_stem_of(const std::string& name);

/// That nothing of a recording of this stem is there. Errors: usage, naming the file.
Result<void> check_free(const std::string& stem);

/// That the header can be stored is known before the first sample, not after the last. Errors: unsuitable, by
/// JSON pointer.
Result<void> check_storable(const RecordingHeader& header);

/// Sets checksum, date and creator for the samples in `wav`, and gives the sidecar's text. Errors: not_found;
/// unsuitable.
Result<std::string> completed_sidecar(RecordingHeader& header, const std::string& wav);

}  // namespace tacto::schema
