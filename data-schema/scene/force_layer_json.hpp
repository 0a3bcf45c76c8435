// SPDX-License-Identifier: GPL-3.0-or-later
// Force layers as JSON. Internal to this folder.
#pragma once

#include "data-schema/scene/patch_json.hpp"

namespace tacto::schema {

/// The scene's schema of a definition, "patch" or "force_layer".
const Json& scene_definition(const char* name);

/// Precondition: the body fits the schema's definition `force_layer`. Errors: as of patch_from.
Result<ForceLayer> force_layer_from(const Json& body, UnknownMembers unknown, const std::string& where);

Json force_layer_body(const ForceLayer& layer);

}  // namespace tacto::schema
