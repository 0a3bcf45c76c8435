// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "data-schema/files/embedded_files.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/transducer/transducer_json.hpp"
#include "data-schema/transducer/transducer_plausible.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kTransducerKind = "transducer";
constexpr std::string_view kTransducerSuffix = ".transducer";

const EmbeddedFile* preset_named(std::string_view name) {
  const auto files = embedded_files();
  const auto found = std::ranges::find(files, fmt::format("{}.transducer.json", name), &EmbeddedFile::name);
  return found == files.end() ? nullptr : &*found;
}

Result<void> check_numbers(const Transducer& transducer, const std::string& where, Numbers numbers) {
  if (numbers == Numbers::plausible)
    if (const auto plausible = check_plausible(transducer, where); !plausible) return plausible;
  return check_computable(transducer, where);
}

Result<Transducer> transducer_of(const Result<Document>& document, const std::string& where,
                                 Numbers numbers) {
  TACTO_TRY(document);
  Transducer transducer = transducer_from(document->body);
  transducer.extra_json = unknown_members(document->body, kTransducerKind);
  transducer.newer_version = document->newer_version;
  TACTO_TRY(check_extras(transducer, where));
  TACTO_TRY(check_numbers(transducer, where, numbers));
  return transducer;
}

std::string path_of(const std::string& stem) {
  return stem + std::string(kTransducerSuffix) + ".json";
}

// A file named in full may have any name; a stem has the suffix added.
std::string existing_path(const std::string& name) {
  const std::string path = path_of(stem_of(name, kTransducerSuffix));
  std::error_code ignored;
  return !std::filesystem::exists(path, ignored) && std::filesystem::is_regular_file(name, ignored) ? name
                                                                                                    : path;
}

}  // namespace

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  for (const EmbeddedFile& file : embedded_files())
    if (const auto at = file.name.find(".transducer.json"); at != std::string_view::npos)
      names.push_back(file.name.substr(0, at));
  std::ranges::sort(names);
  return names;
}

Result<Transducer> read_transducer(const std::string& name, Numbers numbers) {
  if (const EmbeddedFile* preset = preset_named(name))
    return transducer_of(parse_document(preset->text, std::string(preset->name), kTransducerKind), name,
                         numbers);
  const std::string path = existing_path(name);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    return fail(
        ErrorKind::not_found, "there is no such transducer", name,
        fmt::format("the presets are {}; a file is NAME.transducer.json", fmt::join(preset_names(), ", ")));
  return transducer_of(open_document(path, kTransducerKind), path, numbers);
}

Result<void> write_transducer(const std::string& stem, const Transducer& transducer) {
  if (const auto sound = check_extras(transducer, path_of(stem_of(stem, kTransducerSuffix))); !sound)
    return sound;
  const auto text = document_text(kTransducerKind, transducer_body(transducer), transducer.extra_json);
  TACTO_TRY(text);
  PendingFiles pending;
  if (const auto written = pending.write(path_of(stem_of(stem, kTransducerSuffix)), *text); !written)
    return written;
  return pending.commit();
}

}  // namespace tacto::schema
