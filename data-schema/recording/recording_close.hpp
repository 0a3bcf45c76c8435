// SPDX-License-Identifier: GPL-3.0-or-later
// The end of a live recording, at once or later. Internal to this folder.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/event_file.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// Corrects STEM.wav, whose frames are those of the recording; writes STEM.json from the header; removes the
/// events. Errors: malformed, if the WAV's header was never finished; cannot_write; unsuitable.
Result<Recording> close_recording(const std::string& stem, RecordingHeader header, EventFile& events);

}  // namespace tacto::schema
