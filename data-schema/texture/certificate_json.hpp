// SPDX-License-Identifier: GPL-3.0-or-later
// The member `certificate` of a texture's JSON. Internal to this folder.
#pragma once

#include <nlohmann/json.hpp>

#include "data-schema/texture/certificate.hpp"

namespace tacto::schema {

nlohmann::ordered_json certificate_body(const Certificate& certificate);

/// Precondition: the body fits the schema.
Certificate certificate_from(const nlohmann::ordered_json& body);

}  // namespace tacto::schema
