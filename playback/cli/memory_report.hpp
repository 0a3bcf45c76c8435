// SPDX-License-Identifier: GPL-3.0-or-later
// What a program takes of a device's memory, and what would make it fit.
#pragma once

#include <string>

#include "data-schema/report/report.hpp"
#include "playback/player/program.hpp"

namespace tacto::playback {

/// What a program was asked to be; `options.most_samples` is the device's room.
struct AskedProgram {
  ProgramRequest request;
  std::string transducer;
  PrepareOptions options;

  std::size_t room() const { return options.most_samples; }
};

/// The same as if the device had room for 2^26 samples (256 MB), sixteen times what this computer's own loop
/// takes. Errors: as make_program; where it is for another reason than for room, the same as without.
schema::Result<Program> with_room_enough(const AskedProgram& asked);

/// `device_samples`, `needed_samples`, `fits`, and `memory`: each item's bytes against its room on the
/// device.
void add_room(cli::Report& report, const Prepared& made, std::size_t device_samples);

/// `ways_to_fit`, each with the samples that it takes, as prepared: reading by sinc, the longest beginning of
/// a texture that fits (to a hundredth of it; by sinc where no other does), each texture of a scene by
/// itself, this computer's loop. Returns what to do, in words: those that fit, or that none does.
std::string add_ways_to_fit(cli::Report& report, const AskedProgram& asked, const Program& program);

}  // namespace tacto::playback
