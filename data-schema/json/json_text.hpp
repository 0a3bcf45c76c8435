// SPDX-License-Identifier: GPL-3.0-or-later
// JSON text from outside, in one place: stored files, requests and replies.
#pragma once

#include <string>
#include <string_view>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

inline constexpr int kDeepestDocument = 32;  ///< documents of tactograph nest five deep

/// One JSON value. Errors: malformed: not JSON, with line and column; nested deeper than `deepest`, which is
/// found before any recursion; an object with two members of one name, with that name and the object's place
/// as a JSON pointer (readers differ in which of the two they take, so neither is taken).
Result<Json> parse_json(std::string_view text, const std::string& where, int deepest = kDeepestDocument);

/// A member's name as a message quotes it. Names come from outside: a long one is not repeated.
std::string quoted_name(const std::string& name);

/// What the library's exception says, without its own name and place.
std::string json_reason(const std::string& said);

}  // namespace tacto::schema
