// SPDX-License-Identifier: GPL-3.0-or-later
// Text of files and their names, as it may be shown on a terminal.
#pragma once

#include <string>

namespace tacto::cli {

/// What steers a terminal (ASCII's control signs and the C1 set in UTF-8) as "\\x1b". Line ends and tabs
/// stay.
std::string harmless(const std::string& text);

/// Line ends and tabs likewise: what must stay one line.
std::string on_one_line(const std::string& text);

}  // namespace tacto::cli
