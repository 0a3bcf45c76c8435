// SPDX-License-Identifier: GPL-3.0-or-later
// JSON Schemas (draft-07) of this room, and breaches of them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

/// The embedded `KIND.schema.json` with every $ref replaced by what it names ("other.schema.json",
/// "#/definitions/x"); none where no such schema is embedded. Schemas must not refer to themselves. Made once
/// a process: the reference stays valid, from any thread.
const std::optional<Json>& schema_of(std::string_view kind);

/// Every breach of `rules`, in the order in which they were found. Fast if `rules` is the reference that
/// schema_of() returned; otherwise the rules are compiled for this call.
std::vector<Violation> breaches(const Json& document, const Json& rules);

/// The description of a member in the rules; empty if there is none, and for the whole document.
std::string meaning_at(const std::string& pointer, const Json& rules);

/// For a number: its description in the rules, and its range; empty for everything else.
std::string remedy_at(const std::string& pointer, const Json& rules);

}  // namespace tacto::schema
