// SPDX-License-Identifier: GPL-3.0-or-later
// A line of a table cut into its fields, quotes obeyed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tacto::capture {

/// Where the field that begins at `begin` ends: at the next delimiter outside quotes, or at the line's end.
/// A quote that is never closed ends with the line.
std::size_t field_end(std::string_view line, std::size_t begin, char delimiter);

/// How many fields a line has: one more than its delimiters outside quotes.
std::size_t field_count(std::string_view line, char delimiter);

/// A field's content: blanks around it and its quotes removed, doubled quotes made single.
std::string unquoted(std::string_view field);

/// All fields of a line, unquoted.
std::vector<std::string> fields_of(std::string_view line, char delimiter);

/// The line without carriage returns at its end.
std::string_view without_returns(std::string_view line);

/// Lines that hold no fields: blank ones, and comments, whose first character is '#'.
bool is_blank_line(std::string_view line);
bool is_comment_line(std::string_view line);

}  // namespace tacto::capture
