// SPDX-License-Identifier: GPL-3.0-or-later
// Texts in tables for other programs (RFC 4180).
#pragma once

#include <string>

namespace tacto::schema {

/// A cell of a CSV: in quotes where it holds a comma, a quote or a line's end; quotes in it are doubled.
std::string csv_cell(const std::string& text);

/// A cell with a number of so many digits; empty where there is no finite one.
std::string csv_number(double value, int digits = 9);

}  // namespace tacto::schema
