// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/cli/table_output.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "data-schema/file_kind.hpp"
#include "data-schema/files.hpp"

namespace tacto::spatial {

namespace {

// A table of the same kind may be replaced; what was recorded or made may not.
schema::Result<void> check_replaceable(const std::string& path, bool csv) {
  using schema::FileKind;
  if (csv)
    return schema::check_table_free(path, [](std::string_view line) {
      return line.starts_with("texture,from_mm,to_mm,") || line.starts_with("texture,quantity,length_mm,");
    });
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {};
  const auto there = schema::stored_files(path);
  if (!there) return {};
  const FileKind kind = there->front().kind;
  if (kind == FileKind::formants || kind == FileKind::descriptions) return {};
  return schema::fail(schema::Fault::usage,
                      fmt::format("is a {}, and would be lost", schema::kind_name(kind)), path,
                      "choose another name");
}

}  // namespace

TablePath table_path(const std::string& output, const std::string& kind) {
  if (output.ends_with(".csv")) return {output, true};
  if (output.ends_with(".json")) return {output, false};
  return {output + "." + kind + ".json", false};
}

schema::Result<void> write_table(const TablePath& where,
                                 const std::function<schema::Result<std::string>()>& json,
                                 const std::function<std::string()>& csv) {
  if (const auto free = check_replaceable(where.path, where.csv); !free) return free;
  const auto text = where.csv ? csv() : json();
  if (!text) return schema::forward_error(text);
  schema::PendingFiles files;
  if (auto written = files.write(where.path, *text); !written) return written;
  return files.commit();
}

}  // namespace tacto::spatial
