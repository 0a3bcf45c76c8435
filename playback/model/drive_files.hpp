// SPDX-License-Identifier: GPL-3.0-or-later
// Signals over time as plain mono sound files, 32-bit float, in the SI unit of their quantity.
#pragma once

#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::playback {

struct SignalFile {
  std::string path;  ///< ends in .wav
  const schema::TimeSignal* signal = nullptr;
};

/// Call before any computation. Checks that all names end in .wav and are different, that existing files may
/// be replaced, and that none holds the data of a recording or texture (which has a NAME.json beside it).
/// Errors: usage.
schema::Result<void> check_signal_files(std::span<const SignalFile> files, schema::Existing existing);

/// Writes all files or none. Errors: cannot_write; usage, for a rate that no header can hold, or an existing
/// file that must not be replaced; unsuitable, for a sample that is not a finite 32-bit number.
schema::Result<void> write_signal_files(std::span<const SignalFile> files, schema::Existing existing);

}  // namespace tacto::playback
