// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/numbers_sum.hpp"

#include <bit>
#include <map>
#include <vector>

#include "data-schema/base/sha256.hpp"

namespace tacto::schema {
namespace {

static_assert(std::endian::native == std::endian::little);

// Marks, notes, results and what people adjust (playback_gain) are not listed: they may be edited.
std::vector<std::string> covered_members(std::string_view kind) {
  if (kind == "recording") return {"sample_rate_hz", "channels", "gaps", "transducer"};
  if (kind == "texture")
    return {"pitch_m",    "quantity", "unit",      "direction", "source_origin_m",
            "valid_band", "source",   "transform", "average"};
  return {};
}

using Covered = std::map<std::string, std::string>;  // bytes by JSON pointer

std::string bytes_of(double number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

void add(const std::string& pointer, const Json& value, Covered& covered) {
  for (const auto& [name, member] : value.items()) {
    if (value.is_object() && name.starts_with("x_")) continue;
    const std::string place = pointer + (Json::json_pointer() / name).to_string();
    if (member.is_structured())
      add(place, member, covered);
    else if (member.is_number())
      covered[place] = bytes_of(member.get<double>());
    else if (member.is_string() && (name == "quantity" || name == "unit"))
      covered[place] = member.get<std::string>() + "\n";
  }
}

}  // namespace

std::optional<std::string> numbers_sum(std::string_view kind, const Json& document) {
  const auto members = covered_members(kind);
  if (members.empty()) return std::nullopt;
  Json listed = Json::object();
  for (const std::string& member : members)
    if (const auto found = document.find(member); found != document.end()) listed[member] = *found;
  Covered covered;
  add("", listed, covered);
  Sha256 sum;
  for (const auto& [pointer, bytes] : covered) sum.add(pointer), sum.add("\n"), sum.add(bytes);
  return sum.hexadecimal();
}

}  // namespace tacto::schema
