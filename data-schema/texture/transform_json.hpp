// SPDX-License-Identifier: GPL-3.0-or-later
// The member `transform` of a texture's sidecar as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "data-schema/texture/transform.hpp"

namespace tacto::schema {

nlohmann::ordered_json transform_body(const TextureTransform& transform);

/// Reads what transform_body made. Precondition: it fits the texture's schema.
TextureTransform transform_from(const nlohmann::ordered_json& body);

}  // namespace tacto::schema
