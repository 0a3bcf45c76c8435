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

/// Before the work: names that end in .wav, all different, free where what exists is to be kept, none of them
/// the data of a recording or texture (which has its NAME.json beside it). Errors: usage.
schema::Result<void> check_signal_files(std::span<const SignalFile> files, schema::Existing existing);

/// Writes all; they appear together or not at all. Errors: cannot_write; usage, for a rate that no header
/// holds, or where a file that is to be kept has a name; unsuitable, for a sample that is no finite number
/// of 32 bits.
schema::Result<void> write_signal_files(std::span<const SignalFile> files, schema::Existing existing);

}  // namespace tacto::playback
