// SPDX-License-Identifier: GPL-3.0-or-later
// Signals over time as plain mono sound files, 32-bit float, in the SI unit of their quantity.
#pragma once

#include <span>
#include <string>

#include "data-schema/error.hpp"
#include "data-schema/signal.hpp"

namespace tacto::playback {

struct SignalFile {
  std::string path;  ///< ends in .wav
  const schema::TimeSignal* signal = nullptr;
};

/// Before the work: names that end in .wav, all different, none of them the data of a recording or texture
/// (which has its NAME.json beside it). Errors: usage.
schema::Result<void> check_signal_files(std::span<const SignalFile> files);

/// Writes all; they appear together or not at all. Errors: cannot_write; usage, for a rate that no header
/// holds.
schema::Result<void> write_signal_files(std::span<const SignalFile> files);

}  // namespace tacto::playback
