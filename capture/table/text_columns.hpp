// SPDX-License-Identifier: GPL-3.0-or-later
// The text of chosen columns of a table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/table/source.hpp"

namespace tacto::capture {

/// For each of `columns` (0-based) the text of all its rows, in UTF-8, without quotes. The rows are those
/// that read_source() gives: call that first, it checks them. For tables that fit into memory. Precondition:
/// a table (`source.csv`). Errors: not_found.
schema::Result<std::vector<std::vector<std::string>>> read_texts(const Source& source,
                                                                 std::span<const std::size_t> columns);

}  // namespace tacto::capture
