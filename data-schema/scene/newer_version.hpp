// SPDX-License-Identifier: GPL-3.0-or-later
// Messages about a file whose minor version is newer than this program's.
#pragma once

#include <string>
#include <vector>

#include "data-schema/scene/scene.hpp"

namespace tacto::schema {

/// The names of the members in `extra_json` (an object's text, or empty), each behind `place`.
std::vector<std::string> member_names(const std::string& extra_json, const std::string& place = "");

/// One sentence for a reader who uses the file nevertheless; `newer_version` and the ignored members as the
/// reader returned them. Empty if the version is not newer.
std::string note_of_newer_version(const std::string& path, const std::string& newer_version,
                                  const std::vector<std::string>& passed_over);
/// The same for a scene, with the members of its layers and patches by their place.
std::string note_of_newer_version(const std::string& path, const Scene& scene);

}  // namespace tacto::schema
