// SPDX-License-Identifier: GPL-3.0-or-later
// A table that a verb writes, as JSON or CSV by the extension of its path.
#pragma once

#include <functional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::spatial {

/// The path of a table: PATH.csv, PATH.json, or PATH.`kind`.json if the path has neither extension.
struct TablePath {
  std::string path;
  bool csv = false;
};

/// Errors: usage, if the path ends as that of another kind of file.
schema::Result<TablePath> table_path(const std::string& output, const std::string& kind);

/// Checks before any work is done whether the table may be written there. Errors: usage, if a file of that
/// name must not be replaced, or is a recording, a texture or another file that is no such table.
schema::Result<void> check_table(const TablePath& where, schema::Existing existing);

/// Writes the table as a whole or not at all. Errors: of check_table(); cannot_write; those of `json`.
schema::Result<void> write_table(const TablePath& where, schema::Existing existing,
                                 const std::function<schema::Result<std::string>()>& json,
                                 const std::function<std::string()>& csv);

}  // namespace tacto::spatial
