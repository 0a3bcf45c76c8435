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

}  // namespace tacto::schema
