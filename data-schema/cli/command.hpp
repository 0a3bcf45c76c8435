// SPDX-License-Identifier: GPL-3.0-or-later
// The command itself: from a table of verbs and an argument list to output and an exit code.
#pragma once

#include <span>
#include <string>

#include "data-schema/cli/verb.hpp"

namespace tacto::cli {

/// Runs one command line. Results go to stdout, talk and errors to stderr. Gives the exit code: 0, or
/// exit_code() of the fault (2 for the command line itself).
int run_command(std::span<const Verb* const> verbs, int argc, const char* const* argv);

/// The script that makes bash complete verbs, options and file names, made from the same table.
std::string bash_completion(std::span<const Verb* const> verbs);

}  // namespace tacto::cli
