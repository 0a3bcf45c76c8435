// SPDX-License-Identifier: GPL-3.0-or-later
// A table that a verb stores, as JSON or CSV by the path's ending.
#pragma once

#include <functional>
#include <string>

#include "data-schema/error.hpp"

namespace tacto::spatial {

/// Where a table goes: PATH.csv, PATH.json, or PATH.`kind`.json where the path has neither ending.
struct TablePath {
  std::string path;
  bool csv = false;
};

TablePath table_path(const std::string& output, const std::string& kind);

/// Writes it whole or not at all. Errors: usage, where it would replace a recording, a texture or another
/// file that is no table; cannot_write; those of `json`.
schema::Result<void> write_table(const TablePath& where,
                                 const std::function<schema::Result<std::string>()>& json,
                                 const std::function<std::string()>& csv);

}  // namespace tacto::spatial
