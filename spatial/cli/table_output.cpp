// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/cli/table_output.hpp"

#include "data-schema/files.hpp"

namespace tacto::spatial {

TablePath table_path(const std::string& output, const std::string& kind) {
  if (output.ends_with(".csv")) return {output, true};
  if (output.ends_with(".json")) return {output, false};
  return {output + "." + kind + ".json", false};
}

schema::Result<void> write_table(const TablePath& where,
                                 const std::function<schema::Result<std::string>()>& json,
                                 const std::function<std::string()>& csv) {
  const auto text = where.csv ? csv() : json();
  if (!text) return schema::forward_error(text);
  schema::PendingFiles files;
  if (auto written = files.write(where.path, *text); !written) return written;
  return files.commit();
}

}  // namespace tacto::spatial
