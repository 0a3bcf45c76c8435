// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/results_output.hpp"

#include <algorithm>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;
using schema::Result;

bool is_page(const std::string& path) {
  return path.ends_with(".html");
}

const OutputKind* kind_of(const std::string& path, std::span<const OutputKind> more) {
  for (const OutputKind& kind : more)
    if (path.ends_with(kind.ending)) return &kind;
  return nullptr;
}

Result<void> check_output(const std::string& path, schema::Existing existing,
                          std::span<const OutputKind> more) {
  if (const OutputKind* kind = kind_of(path, more))
    return schema::check_table_free(path, existing, kind->ours);
  if (is_page(path))
    return schema::check_table_free(
        path, existing, [](std::string_view line) { return line.starts_with("<!DOCTYPE html>"); });
  if (path.ends_with(".json")) return schema::check_results_free(path, existing);
  std::string endings;
  for (const OutputKind& kind : more) endings += ", NAME" + kind.ending;
  return schema::fail(ErrorKind::usage, "has an ending that this verb does not write", path,
                      "name a page (NAME.html) or results (NAME.results.json)" + endings);
}

}  // namespace

Result<void> check_outputs(const std::vector<std::string>& outputs, schema::Existing existing,
                           std::span<const OutputKind> more) {
  for (auto path = outputs.begin(); path != outputs.end(); ++path) {
    if (std::any_of(outputs.begin(), path,
                    [&](const auto& other) { return schema::same_file(*path, other); }))
      return schema::fail(ErrorKind::usage, "is named twice", *path, "give each output a different name");
    if (const auto free = check_output(*path, existing, more); !free) return free;
  }
  return {};
}

Result<void> write_outputs(const std::vector<std::string>& outputs, schema::Existing existing,
                           schema::Results results, const cli::Report& details,
                           const std::function<Result<std::string>()>& page,
                           std::span<const OutputKind> more) {
  results.details_json = details.json();
  results.created = schema::creation_time();
  results.creator = kCreator;
  schema::PendingFiles files;
  for (const std::string& path : outputs) {
    const OutputKind* kind = kind_of(path, more);
    const auto text = kind ? kind->make() : is_page(path) ? page() : schema::results_json(results);
    TACTO_TRY(text);
    if (auto written = files.write(path, *text); !written) return written;
  }
  return files.commit(existing);
}

}  // namespace tacto::analysis
