// SPDX-License-Identifier: GPL-3.0-or-later
// The memory that a program needs on a device, and what would make it fit.
#pragma once

#include <string>

#include "data-schema/report/report.hpp"
#include "playback/player/program.hpp"

namespace tacto::playback {

/// The request for a program; `options.most_samples` is the device's memory.
struct AskedProgram {
  ProgramRequest request;
  std::string transducer;
  PrepareOptions options;

  std::size_t room() const { return options.most_samples; }
};

/// The program for a device with memory for 2^26 samples (256 MB), sixteen times that of the loop on this
/// computer. Errors: as make_program; if memory is not the cause, the same as without.
schema::Result<Program> with_room_enough(const AskedProgram& asked);

/// Adds `device_samples`, `needed_samples`, `fits`, and `memory`: for each item its bytes and the device's
/// memory for it.
void add_room(cli::Report& report, const Prepared& made, std::size_t device_samples);

/// Adds `ways_to_fit`, each with the number of samples, as prepared: interpolation by sinc, the longest
/// beginning of a texture that fits (to a hundredth of it; by sinc if no other does), each texture of a scene
/// by itself, the loop on this computer. Returns what to do, in words: the ways that fit, or that none does.
std::string add_ways_to_fit(cli::Report& report, const AskedProgram& asked, const Program& program);

}  // namespace tacto::playback
