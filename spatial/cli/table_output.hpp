// SPDX-License-Identifier: GPL-3.0-or-later
// A table that a verb stores, as JSON or CSV by the path's ending.
#pragma once

#include <functional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::spatial {

/// Where a table goes: PATH.csv, PATH.json, or PATH.`kind`.json where the path has neither ending.
struct TablePath {
  std::string path;
  bool csv = false;
};

TablePath table_path(const std::string& output, const std::string& kind);

/// Before any work is done: whether the table may be written there. Errors: usage, where a file has the name
/// and is to be kept, or is a recording, a texture or another file that is no such table.
schema::Result<void> check_table(const TablePath& where, schema::Existing existing);

/// Writes it whole or not at all. Errors: of check_table(); cannot_write; those of `json`.
schema::Result<void> write_table(const TablePath& where, schema::Existing existing,
                                 const std::function<schema::Result<std::string>()>& json,
                                 const std::function<std::string()>& csv);

}  // namespace tacto::spatial
