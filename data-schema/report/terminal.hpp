// SPDX-License-Identifier: GPL-3.0-or-later
// Text for a terminal: messages beside the results, and text of files and their names without control
// characters.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace tacto::cli {

/// Writes to stderr unchanged. If that fails (closed, a full disk, a pipe without a reader), the work
/// continues without an error: unlike fmt::print this does not throw.
inline void write_message(std::string_view text) noexcept {
  [[maybe_unused]] const std::size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
}

/// Terminal control characters (ASCII's and the C1 set in UTF-8) become "\\x1b" and the like. Line ends and
/// tabs stay.
std::string without_controls(const std::string& text);

/// A word of a command line: in single quotes if a shell would read it otherwise.
std::string shell_word(const std::string& text);

/// Also line ends and tabs: for text that must stay one line.
std::string on_one_line(const std::string& text);

}  // namespace tacto::cli
