// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/cli/table_output.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "data-schema/command/output_options.hpp"
#include "data-schema/kinds/file_kind.hpp"

namespace tacto::spatial {

namespace {

bool is_table(std::string_view line) {
  return line.starts_with("texture,from_mm,to_mm,") || line.starts_with("texture,quantity,length_mm,");
}

// A table of the same kind may be replaced, but not a recording, a texture or another file.
schema::Result<void> check_kind(const std::string& path) {
  using schema::FileKind;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored) || std::filesystem::is_empty(path, ignored)) return {};
  const auto there = schema::stored_files(path);
  const auto kind = there ? std::optional(there->front().kind) : std::nullopt;
  if (kind == FileKind::formants || kind == FileKind::descriptions) return {};
  return schema::fail(schema::ErrorKind::usage,
                      kind ? fmt::format("is a {} and is not overwritten", schema::kind_name(*kind))
                           : "has other contents and is not overwritten",
                      path, "choose another name");
}

}  // namespace

schema::Result<TablePath> table_path(const std::string& output, const std::string& kind) {
  TACTO_TRY(cli::check_ending(output, {".csv", ".json"}, "use .csv, .json, or a name without an ending"));
  if (output.ends_with(".csv")) return TablePath{output, true};
  if (output.ends_with(".json")) return TablePath{output, false};
  return TablePath{output + "." + kind + ".json", false};
}

schema::Result<void> check_table(const TablePath& where, schema::Existing existing) {
  if (where.csv) return schema::check_table_free(where.path, existing, is_table);
  const auto ours = check_kind(where.path);
  return ours ? schema::check_output_free(where.path, existing) : ours;
}

schema::Result<void> write_table(const TablePath& where, schema::Existing existing,
                                 const std::function<schema::Result<std::string>()>& json,
                                 const std::function<std::string()>& csv) {
  if (const auto free = check_table(where, existing); !free) return free;
  const auto text = where.csv ? csv() : json();
  TACTO_TRY(text);
  schema::PendingFiles files;
  if (auto written = files.write(where.path, *text); !written) return written;
  return files.commit(existing);
}

}  // namespace tacto::spatial
