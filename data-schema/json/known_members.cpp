// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/known_members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"

namespace tacto::schema {
namespace {

// Levenshtein's distance: letters inserted, removed or changed.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t corner = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = corner + (a[i] != b[j]);
      corner = row[j + 1];
      row[j + 1] = std::min({changed, corner + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::vector<std::string> names_in(const Json& rule) {
  std::vector<std::string> names;
  for (const auto& [name, value] : rule["properties"].items()) names.push_back(name);
  return names;
}

// Up to three letters, as `energy_rms` for `energy_rms_v`, but fewer than a short name has.
bool is_near(std::string_view said, std::string_view name) {
  return distance(said, name) <= std::min<std::size_t>(3, name.size() / 2);
}

std::string near_member_or_all(const std::string& said, const Json& rule) {
  const auto names = names_in(rule);
  // Long names are not compared letter by letter: this is text from outside.
  const std::string_view brief = std::string_view(said).substr(0, 64);
  const auto nearest =
      std::ranges::min(names, {}, [&](const std::string& name) { return distance(brief, name); });
  if (is_near(brief, nearest)) return fmt::format("did you mean '{}'?", nearest);
  return fmt::format("the known members are {}", fmt::join(names, ", "));
}

Json unknown_in(const Json& rule, const Json& body) {
  Json unknown = Json::object();
  for (const auto& [name, value] : body.items()) {
    if (!rule["properties"].contains(name)) {
      unknown[name] = value;
      continue;
    }
    const Json& inner = rule["properties"][name];
    if (!value.is_object() || !inner.contains("properties")) continue;
    if (Json within = unknown_in(inner, value); !within.empty()) unknown[name] = std::move(within);
  }
  return unknown;
}

void add_members(Json& body, const Json& extra) {
  for (const auto& [name, value] : extra.items()) {
    if (!body.contains(name))
      body[name] = value;
    else if (body[name].is_object() && value.is_object())
      add_members(body[name], value);
  }
}

// FILE#/a/b; `where` may be FILE alone.
std::string place_in(const std::string& where, const std::string& step) {
  return where + (where.find('#') == std::string::npos ? "#/" : "/") + step;
}

Result<void> check_elements_known(const Json& rule, const Json& body, const std::string& where) {
  if (!rule.contains("items")) return {};
  for (std::size_t i = 0; i < body.size(); ++i)
    TACTO_TRY(check_all_members_known(rule["items"], body[i], place_in(where, std::to_string(i))));
  return {};
}

}  // namespace

std::vector<std::string> members_not_in(const Json& rule, const Json& body) {
  std::vector<std::string> unknown;
  for (const auto& [name, value] : body.items())
    if (!rule["properties"].contains(name)) unknown.push_back(name);
  return unknown;
}

Result<void> check_members_known(const Json& rule, const Json& body, const std::string& where) {
  const auto unknown = members_not_in(rule, body);
  if (unknown.empty()) return {};
  return fail(ErrorKind::malformed,
              fmt::format("the member {} is unknown here", quoted_name(unknown.front())), where,
              near_member_or_all(unknown.front(), rule));
}

Result<void> check_all_members_known(const Json& rule, const Json& body, const std::string& where) {
  if (body.is_array()) return check_elements_known(rule, body, where);
  if (!body.is_object() || !rule.contains("properties")) return {};
  TACTO_TRY(check_members_known(rule, body, where));
  for (const auto& [name, value] : body.items())
    TACTO_TRY(check_all_members_known(rule["properties"][name], value, place_in(where, name)));
  return {};
}

Result<void> check_document_known(const Document& document, std::string_view kind, const std::string& where) {
  if (!document.newer_version.empty()) return {};
  return check_all_members_known(*schema_of(kind), document.body, where);
}

std::string unknown_parts(const Json& rule, const Json& body) {
  const Json unknown = unknown_in(rule, body);
  return unknown.empty() ? "" : unknown.dump();
}

void add_unknown_parts(Json& body, const std::string& extra_json) {
  if (!extra_json.empty()) add_members(body, Json::parse(extra_json));
}

}  // namespace tacto::schema
