// SPDX-License-Identifier: GPL-3.0-or-later
// Detects misspelt members, which would be ignored otherwise. Internal to this folder.
#pragma once

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

/// The members of an object that `rule`, its schema, does not contain.
std::vector<std::string> members_not_in(const Json& rule, const Json& body);

/// Errors: malformed, at `where`, naming the first member that `rule` does not contain, and the nearest known
/// member, or all of them if none is near.
Result<void> check_members_known(const Json& rule, const Json& body, const std::string& where);

/// The same for the objects and arrays in it, as far as `rule` describes them; their places follow `where`.
Result<void> check_all_members_known(const Json& rule, const Json& body, const std::string& where);

/// The same for a document of `kind`, unless its minor version is newer: then unknown members are kept.
Result<void> check_document_known(const Document& document, std::string_view kind, const std::string& where);

/// The text of an object with the members that `rule` does not contain, also those within objects that it
/// contains (not within arrays); empty if there are none.
std::string unknown_parts(const Json& rule, const Json& body);

/// Adds such a text's members to a body, where it has none of that name.
void add_unknown_parts(Json& body, const std::string& extra_json);

}  // namespace tacto::schema
