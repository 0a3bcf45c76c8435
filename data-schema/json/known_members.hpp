// SPDX-License-Identifier: GPL-3.0-or-later
// Members that a misspelling would lose. Internal to this folder.
#pragma once

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

/// Of an object: the members that `rule`, its schema, does not name.
std::vector<std::string> members_not_in(const Json& rule, const Json& body);

/// Errors: malformed, at `where`, naming the first member that `rule` does not name, and the nearest that it
/// does, or all of them where none is near.
Result<void> check_members_known(const Json& rule, const Json& body, const std::string& where);

}  // namespace tacto::schema
