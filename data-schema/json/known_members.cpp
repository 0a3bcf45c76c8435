// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/known_members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

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

std::string remedy_for(const std::string& said, const Json& rule) {
  const auto names = names_in(rule);
  // Long names are not compared letter by letter: this is text from outside.
  const std::string_view brief = std::string_view(said).substr(0, 64);
  const auto nearest =
      std::ranges::min(names, {}, [&](const std::string& name) { return distance(brief, name); });
  if (is_near(brief, nearest)) return fmt::format("is '{}' meant?", nearest);
  return fmt::format("its members are {}", fmt::join(names, ", "));
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
              fmt::format("the member {} is not known here", quoted_name(unknown.front())), where,
              remedy_for(unknown.front(), rule));
}

}  // namespace tacto::schema
