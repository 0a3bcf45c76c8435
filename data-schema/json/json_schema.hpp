// SPDX-License-Identifier: GPL-3.0-or-later
// JSON Schemas (draft-07) of this folder, and what in a document breaks them. Internal to this folder.
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

/// Every breach of `rules`, in the order they were found. Quick where `rules` is what schema_of() gave, by
/// reference: else they are compiled for this call.
std::vector<Violation> breaches(const Json& document, const Json& rules);

/// What the rules say that a member is; empty where they do not, and of the whole document.
std::string meaning_at(const std::string& pointer, const Json& rules);

/// Of a number: what the rules say that it is, and its range; empty of everything else.
std::string remedy_at(const std::string& pointer, const Json& rules);

}  // namespace tacto::schema
