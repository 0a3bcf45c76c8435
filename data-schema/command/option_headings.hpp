// SPDX-License-Identifier: GPL-3.0-or-later
// The order of a verb's help: the usual options first, the others below headings.
#pragma once

#include <CLI/CLI.hpp>
#include <string_view>

namespace tacto::cli {

/// Of a verb with more than ten options: the usual ones, ten at most, come first; every other one below the
/// heading of what it is about. Call it when all options are declared.
void put_below_headings(std::string_view verb, CLI::App& app);

}  // namespace tacto::cli
