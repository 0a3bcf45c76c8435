// SPDX-License-Identifier: GPL-3.0-or-later
// Manual pages in section 1, made from the table of verbs, for `man tactograph-spatial`.
#pragma once

#include <span>
#include <string>

#include "data-schema/command/verb.hpp"

namespace tacto::cli {

/// A page's file name (`tactograph-spatial.1`) and its text in roff (man macros).
struct ManPage {
  std::string file, text;
};

/// One page for the command and one for each verb.
std::vector<ManPage> man_pages(std::span<const Verb* const> verbs);

/// Writes them into an existing folder, replacing pages of the same names. Errors: cannot_write.
schema::Result<void> write_man_pages(const std::string& folder, std::span<const Verb* const> verbs);

}  // namespace tacto::cli
