// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's members as JSON, for its own file and for recordings and sessions that embed it. Internal
// to data-schema.
#pragma once

#include <nlohmann/json.hpp>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {

/// Every parameter under its C++ name, without `kind` and `version`.
nlohmann::ordered_json transducer_body(const Transducer& transducer);

/// Reads a body made by transducer_body. Precondition: the members fit the transducer's schema. extra_json
/// and newer_version stay empty.
Transducer transducer_from(const nlohmann::ordered_json& body);

}  // namespace tacto::schema
