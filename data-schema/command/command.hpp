// SPDX-License-Identifier: GPL-3.0-or-later
// The command itself: from a table of verbs and an argument list to output and an exit code.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data-schema/command/help.hpp"
#include "data-schema/command/verb.hpp"

namespace tacto::cli {

/// Verbs below one heading of the help, in the order of use.
struct VerbGroup {
  std::string heading;
  std::vector<const Verb*> verbs;
};

/// Runs one command line; `topics` are explained by `help` beside the verbs. Results go to stdout, messages
/// and errors to stderr. Returns the exit code: 0, or exit_code() of the fault (2 for the command line
/// itself).
int run_command(std::span<const VerbGroup> groups, int argc, const char* const* argv,
                std::span<const HelpTopic* const> topics = {});

/// The script that makes bash complete verbs, options, their values and units, presets, keys of `sim:` (the
/// first words of that topic's lines) and file names, made from the same table.
std::string bash_completion(std::span<const Verb* const> verbs,
                            std::span<const HelpTopic* const> topics = {});

}  // namespace tacto::cli
