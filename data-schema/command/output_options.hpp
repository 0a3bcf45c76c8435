// SPDX-License-Identifier: GPL-3.0-or-later
// --force and --unfit-transducer, the same in every verb that has them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "data-schema/command/verb.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::cli {

/// --force: outputs replace existing files. Sets `existing` to keep, with the flag to replace; it must
/// outlive the parser.
void declare_force(CLI::App& app, schema::Existing& existing);

/// Checks the ending of an output's name before any work is done: it is one of `endings`, or none of those
/// that name another format (a name may contain a dot: "trial.3"). Errors: usage, with `remedy`.
schema::Result<void> check_ending(const std::string& output, std::initializer_list<std::string_view> endings,
                                  const std::string& remedy);

/// --unfit-transducer; `taken` must outlive the parser.
void declare_unfit_transducer(CLI::App& app, bool& taken);

/// For a verb that replaces no files: --force is refused, and the message names --unfit-transducer, the new
/// name of the option.
void refuse_force(CLI::App& app);

}  // namespace tacto::cli
