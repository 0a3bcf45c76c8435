// SPDX-License-Identifier: GPL-3.0-or-later
// Makes text of files and their names safe for a terminal.
#pragma once

#include <string>

namespace tacto::cli {

/// Terminal control characters (ASCII's and the C1 set in UTF-8) become "\\x1b" and the like. Line ends and
/// tabs stay.
std::string harmless(const std::string& text);

/// Also line ends and tabs: for text that must stay one line.
std::string on_one_line(const std::string& text);

}  // namespace tacto::cli
