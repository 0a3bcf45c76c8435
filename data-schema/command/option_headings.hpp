// SPDX-License-Identifier: GPL-3.0-or-later
// The order of a verb's help: the usual options first, the others below headings.
#pragma once

#include <CLI/CLI.hpp>
#include <string_view>

namespace tacto::cli {

/// For a verb with more than ten options: the usual ones, ten at most, come first; the others are below a
/// heading for each subject. Call it after all options are declared.
void put_below_headings(std::string_view verb, CLI::App& app);

}  // namespace tacto::cli
