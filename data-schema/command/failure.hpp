// SPDX-License-Identifier: GPL-3.0-or-later
// How a command reports a failure.
#pragma once

#include "data-schema/base/error.hpp"

namespace tacto::cli {

/// One line on stderr, "tactograph: where: what (remedy)", or with `json` an object on one line: what, where,
/// remedy, exit_code. Returns the exit code.
int print_error(const schema::Error& error, bool json);

/// Whether the arguments ask for JSON: needed before they are parsed, because parsing may fail.
bool asks_for_json(int argc, const char* const* argv);

}  // namespace tacto::cli
