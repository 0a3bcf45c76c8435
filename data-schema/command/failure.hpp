// SPDX-License-Identifier: GPL-3.0-or-later
// How a command says that it failed.
#pragma once

#include "data-schema/base/error.hpp"

namespace tacto::cli {

/// One line on stderr, "tactograph: where: what (remedy)", or with `json` an object on one line: what, where,
/// remedy, exit_code. Gives the exit code.
int print_error(const schema::Error& error, bool json);

/// Whether the arguments ask for JSON: known before they are parsed, because parsing may fail.
bool asks_for_json(int argc, const char* const* argv);

}  // namespace tacto::cli
