// SPDX-License-Identifier: GPL-3.0-or-later
// One number of a table as other programs write it: decimal point or comma, never NaN or infinite.
#pragma once

#include <string_view>

namespace tacto::capture {

/// Why a field is no number that can be kept.
enum class NumberFault {
  none,
  missing,      ///< nothing, or only spaces
  text,         ///< anything else than one number, thousands separators among them
  nan,          ///< NaN, also as C, MATLAB and older Windows programs write it
  infinite,     ///< Inf, likewise
  too_large,    ///< outside what a double can hold
  mixed_marks,  ///< a decimal comma where the file has decimal points, or the other way round
};

/// Reads one field without quotes. `mark` is the file's decimal mark, 0 until a field has shown it; it is set
/// by the first field that has one. Rounds to the nearest double, as strtod does. Pure; never throws.
NumberFault read_number(std::string_view field, char& mark, double& value);

/// Whether a field is text, so that it may name a column: neither empty nor a number, NaN or infinite.
bool is_name(std::string_view field);
/// Whether it is a number, or NaN or infinite.
bool is_numeric(std::string_view field);

/// The field without spaces and tabs at either end.
std::string_view trimmed(std::string_view field);

}  // namespace tacto::capture
