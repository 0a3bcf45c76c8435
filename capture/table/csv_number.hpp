// SPDX-License-Identifier: GPL-3.0-or-later
// One number of a table, with decimal point or comma; NaN and infinite numbers are refused.
#pragma once

#include <string_view>

namespace tacto::capture {

/// The reason why a field is not an accepted number.
enum class NumberFault {
  none,
  missing,      ///< empty, or only spaces
  text,         ///< anything other than one number, also thousands separators
  nan,          ///< NaN, also in the notation of C, MATLAB and older Windows programs
  infinite,     ///< Inf, in the same notations
  too_large,    ///< outside the range of a double
  mixed_marks,  ///< a decimal comma in a file with decimal points, or the reverse
};

/// Reads one field without quotes. `mark` is the decimal mark of the file; it is 0 until the first field with
/// a decimal mark sets it. Rounds to the nearest double, as strtod does. Pure; never throws.
NumberFault read_number(std::string_view field, char& mark, double& value);

/// Whether a field is text and may be the name of a column: neither empty nor a number, NaN or infinite.
bool is_name(std::string_view field);
/// Whether a field is a number, NaN or infinite.
bool is_numeric(std::string_view field);

/// The field without leading and trailing spaces and tabs.
std::string_view trimmed(std::string_view field);

}  // namespace tacto::capture
