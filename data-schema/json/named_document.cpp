// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/named_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "data-schema/files/embedded_files.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

std::string ending_of_kind(std::string_view kind) {
  return fmt::format(".{}.json", kind);
}

const EmbeddedFile* preset_file(std::string_view kind, std::string_view name) {
  const auto files = embedded_files();
  const auto found = std::ranges::find(files, std::string(name) + ending_of_kind(kind), &EmbeddedFile::name);
  return found == files.end() ? nullptr : &*found;
}

// A file named in full may have any name; a stem has the ending added.
std::string existing_path(std::string_view kind, const std::string& name) {
  std::string path = path_of_kind(kind, name);
  std::error_code ignored;
  return !std::filesystem::exists(path, ignored) && std::filesystem::is_regular_file(name, ignored) ? name
                                                                                                    : path;
}

Result<NamedDocument> placed(Result<Document> document, const std::string& where) {
  TACTO_TRY(document);
  return NamedDocument{std::move(*document), where};
}

}  // namespace

std::vector<std::string_view> preset_names(std::string_view kind) {
  const std::string ending = ending_of_kind(kind);
  std::vector<std::string_view> names;
  for (const EmbeddedFile& file : embedded_files())
    if (file.name.ends_with(ending)) names.push_back(file.name.substr(0, file.name.size() - ending.size()));
  std::ranges::sort(names);
  return names;
}

std::string path_of_kind(std::string_view kind, const std::string& name) {
  return stem_of(name, fmt::format(".{}", kind)) + ending_of_kind(kind);
}

Result<NamedDocument> open_named(std::string_view kind, const std::string& name) {
  if (const EmbeddedFile* preset = preset_file(kind, name))
    return placed(parse_document(preset->content, std::string(preset->name), kind), name);
  const std::string path = existing_path(kind, name);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    const auto presets = preset_names(kind);
    const std::string listed =
        presets.empty() ? "" : fmt::format("the presets are {}; ", fmt::join(presets, ", "));
    return fail(ErrorKind::not_found, fmt::format("there is no such {}", kind), name,
                fmt::format("{}a file is NAME{}", listed, ending_of_kind(kind)));
  }
  return placed(open_document(path, kind), path);
}

Result<void> write_named(std::string_view kind, const std::string& name, const Json& body,
                         const std::string& extra_json) {
  const auto text = document_text(kind, body, extra_json);
  TACTO_TRY(text);
  PendingFiles pending;
  TACTO_TRY(pending.write(path_of_kind(kind, name), *text));
  return pending.commit();
}

}  // namespace tacto::schema
