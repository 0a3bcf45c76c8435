// SPDX-License-Identifier: GPL-3.0-or-later
// Manual pages, made from what --help and `tactograph help` print: `man tactograph-spatial`, `man
// tactographd`.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/command/help.hpp"

namespace tacto::cli {

/// Writes the pages into `folder`: man1 for the command and each of its verbs, man7 for each topic, man8 for
/// each of the other `programs` (paths), from what they print with --help. Makes the folders, and replaces
/// pages of the same names. `app` has all verbs with their options. Errors: cannot_write; not_found for a
/// program without help.
schema::Result<void> write_man_pages(const std::string& folder, const CLI::App& app,
                                     std::span<const HelpTopic* const> topics,
                                     const std::vector<std::string>& programs);

}  // namespace tacto::cli
