// SPDX-License-Identifier: GPL-3.0-or-later
// Members that a schema does not name: refused where they steer something, warned of and kept elsewhere.
// Names that begin with `x_` are free for laboratories: they are kept everywhere, without a warning. Internal
// to data-schema.
#pragma once

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

/// Where the members are that `rule` (a schema) does not name, as "axes/0/colour": also within objects and
/// arrays, as far as `rule` describes them. Without those that begin with `x_`.
std::vector<std::string> unknown_members(const Json& rule, const Json& body);

/// Errors: malformed, at the first of unknown_members(), with the nearest known member, or all of them if
/// none is near. `where` is FILE or FILE#/pointer.
Result<void> check_members_known(const Json& rule, const Json& body, const std::string& where);

/// The same for a document of `kind`, unless its minor version is newer: then unknown members are kept.
Result<void> check_document_known(const Document& document, std::string_view kind, const std::string& where);

/// Unknown members with their values, those that begin with `x_` too: the text of an object like `body` with
/// nothing else (null for an element of an array without any); empty if there are none.
std::string unknown_parts(const Json& rule, const Json& body);

/// Adds such a text's members to a body, where it has none of that name.
void add_unknown_parts(const Json& rule, Json& body, const std::string& extra_json);

}  // namespace tacto::schema
