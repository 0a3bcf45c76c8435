// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/known_members.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kFreePrefix = "x_";
constexpr std::size_t kLongestName = 64;

using Pointer = Json::json_pointer;
using Visit = std::function<void(const Json& rule, const Pointer& place, const std::string& name)>;

constexpr const char *kNamed = "properties", *kFreelyNamed = "additionalProperties";

bool has_members(const Json& rule) {
  return rule.contains(kNamed) || (rule.contains(kFreelyNamed) && rule[kFreelyNamed].is_object());
}

// Of a member; null if it is unknown. Precondition: the rule has members.
const Json* rule_of(const Json& rule, const std::string& name) {
  if (rule.contains(kNamed) && rule[kNamed].contains(name)) return &rule[kNamed][name];
  return rule.contains(kFreelyNamed) && rule[kFreelyNamed].is_object() ? &rule[kFreelyNamed] : nullptr;
}

// Calls `visit` for each unknown member that is not free; `place` is that of the object.
void for_each_unknown(const Json& rule, const Json& body, const Pointer& place, const Visit& visit) {
  if (body.is_array() && rule.contains("items"))
    for (std::size_t i = 0; i < body.size(); ++i) for_each_unknown(rule["items"], body[i], place / i, visit);
  if (!body.is_object() || !has_members(rule)) return;
  for (const auto& [name, value] : body.items()) {
    if (const Json* const known = rule_of(rule, name))
      for_each_unknown(*known, value, place / name, visit);
    else if (!name.starts_with(kFreePrefix))
      visit(rule, place, name);
  }
}

std::string near_member_or_all(const std::string& said, const Json& rule) {
  std::vector<std::string> names;
  for (const auto& [name, value] : rule["properties"].items()) names.push_back(name);
  const std::string nearest = nearest_word(said, names);
  if (!nearest.empty()) return fmt::format("did you mean '{}'?", nearest);
  return fmt::format("the known members are {}", fmt::join(names, ", "));
}

// FILE#/a/b; `where` may be FILE alone. Names come from outside: a long one is not repeated.
std::string place_in(const std::string& where, const Pointer& object, const std::string& name) {
  const std::string pointer = (name.size() <= kLongestName ? object / name : object).to_string();
  if (pointer.empty()) return where;
  return where + (where.find('#') == std::string::npos ? "#" : "") + pointer;
}

// Null if there is none.
Json parts_of(const Json& rule, const Json& body) {
  Json parts;
  if (body.is_array() && rule.contains("items")) {
    for (const Json& element : body) parts.push_back(parts_of(rule["items"], element));
    if (std::ranges::all_of(parts, [](const Json& part) { return part.is_null(); })) return {};
  }
  if (!body.is_object() || !has_members(rule)) return parts;
  for (const auto& [name, value] : body.items()) {
    const Json* const known = rule_of(rule, name);
    if (known == nullptr)
      parts[name] = value;
    else if (Json within = parts_of(*known, value); !within.is_null())
      parts[name] = std::move(within);
  }
  return parts;
}

// Only into what is there: a known object or element that was removed does not come back.
void add_parts(const Json& rule, Json& body, const Json& parts) {
  if (body.is_array() && parts.is_array())
    for (std::size_t i = 0; i < std::min(body.size(), parts.size()); ++i)
      add_parts(rule["items"], body[i], parts[i]);
  if (!body.is_object() || !parts.is_object()) return;
  for (const auto& [name, value] : parts.items()) {
    const Json* const known = rule_of(rule, name);
    if (!body.contains(name)) {
      if (known == nullptr) body[name] = value;
    } else if (known != nullptr) {
      add_parts(*known, body[name], value);
    }
  }
}

}  // namespace

std::vector<std::string> unknown_members(const Json& rule, const Json& body) {
  std::vector<std::string> names;
  for_each_unknown(rule, body, Pointer(), [&](const Json& /*rule*/, const Pointer& place, const auto& name) {
    names.push_back((place / name).to_string().substr(1));
  });
  return names;
}

Result<void> check_members_known(const Json& rule, const Json& body, const std::string& where) {
  Result<void> first;
  for_each_unknown(rule, body, Pointer(), [&](const Json& of, const Pointer& place, const std::string& name) {
    if (first)
      first = fail(ErrorKind::malformed, fmt::format("the member {} is unknown here", quoted_name(name)),
                   place_in(where, place, name), near_member_or_all(name, of));
  });
  return first;
}

Result<void> check_document_known(const Document& document, std::string_view kind, const std::string& where) {
  if (!document.newer_version.empty()) return {};
  return check_members_known(*schema_of(kind), document.body, where);
}

std::string unknown_parts(const Json& rule, const Json& body) {
  const Json parts = parts_of(rule, body);
  return parts.is_null() ? "" : parts.dump();
}

void add_unknown_parts(const Json& rule, Json& body, const std::string& extra_json) {
  if (!extra_json.empty()) add_parts(rule, body, Json::parse(extra_json));
}

}  // namespace tacto::schema
