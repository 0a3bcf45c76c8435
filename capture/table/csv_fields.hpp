// SPDX-License-Identifier: GPL-3.0-or-later
// Splits a line of a table into its fields, with quotes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tacto::capture {

/// The end of the field that begins at `begin`: the next delimiter outside quotes, or the end of the line. A
/// quote that is not closed ends with the line.
std::size_t field_end(std::string_view line, std::size_t begin, char delimiter);

/// The number of fields in a line: one more than the number of delimiters outside quotes.
std::size_t field_count(std::string_view line, char delimiter);

/// The content of a field: without surrounding blanks and quotes, doubled quotes made single.
std::string unquoted(std::string_view field);

/// All fields of a line, unquoted.
std::vector<std::string> fields_of(std::string_view line, char delimiter);

/// The line without carriage returns at its end.
std::string_view without_returns(std::string_view line);

/// Lines without fields: blank ones, and comments, whose first character is '#'.
bool is_blank_line(std::string_view line);
bool is_comment_line(std::string_view line);

}  // namespace tacto::capture
