// SPDX-License-Identifier: GPL-3.0-or-later
// Documents that are named by a preset, a stem or a file. Internal to this room: it shows JSON.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

/// The names of the presets of a kind that come with tactograph, sorted: of "transducer", "wiertlewski2011".
std::vector<std::string_view> preset_names(std::string_view kind);

/// NAME.KIND.json of a stem, NAME.KIND or NAME.KIND.json.
std::string path_of_kind(std::string_view kind, const std::string& name);

struct NamedDocument {
  Document document;
  std::string where;  ///< the file, or the preset's name: for errors
};

/// By preset name, stem (NAME.KIND.json) or file with any name; a preset has priority. Errors: not_found,
/// with the presets; else as open_document.
Result<NamedDocument> open_named(std::string_view kind, const std::string& name);

/// Writes NAME.KIND.json whole, as document_text makes it. Errors: cannot_write; unsuitable.
Result<void> write_named(std::string_view kind, const std::string& name, const Json& body,
                         const std::string& extra_json);

}  // namespace tacto::schema
