// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/json_document.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <map>
#include <optional>

#include "data-schema/base/format_version.hpp"
#include "data-schema/base/sha256.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"
#include "data-schema/json/known_members.hpp"

namespace tacto::schema {
namespace {

std::string place(const std::string& where, const std::string& pointer) {
  return pointer.empty() ? where : where + "#" + pointer;
}

// `expected`: the kind that the file should have; may be empty.
Result<std::string> kind_in(const Json& body, const std::string& where, std::string_view expected = "") {
  const bool named = body.is_object() && body.contains("kind") && body["kind"].is_string();
  if (!named)
    return fail(ErrorKind::malformed, "JSON without a `kind`: not a file of tactograph", where,
                expected.empty()
                    ? ""
                    : fmt::format(R"(add "kind": "{}", "version": "{}")", expected, kFormatVersion));
  return body["kind"].get<std::string>();
}

Result<std::string> newer_version_in(const Json& body, const std::string& where) {
  const bool named = body.contains("version") && body["version"].is_string();
  return newer_version(named ? body["version"].get<std::string>() : "", where, place(where, "/version"));
}

// The first breach; of missing members all that its object lacks.
std::string first_words(const std::vector<Violation>& list) {
  constexpr std::string_view kMissing = "Missing required property";
  const Violation& first = list.front();
  std::string more;
  for (std::size_t i = 1; i < list.size() && first.what.starts_with(kMissing); ++i)
    if (list[i].pointer == first.pointer && list[i].what.starts_with(kMissing))
      more += (more.empty() ? " " : ", ") + list[i].what.substr(kMissing.size() + 1);
  return more.empty() ? first.what : fmt::format("{}; missing, too:{}", first.what, more);
}

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

// SHA-256 of a recording or texture (`data.numbers_sha256`); nothing for other kinds. Covers the members
// that covered_members() lists for the kind: all their numbers, quantities and units, but no other text and
// no member x_... For each of them, ordered by the bytes of its JSON pointer: pointer, line feed, then the
// number as a little-endian float64, or the text and a line feed.
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

// A file without this checksum is of another program, or was edited on purpose.
Result<void> check_numbers_sum(const Json& body, const std::string& where, std::string_view kind) {
  const auto sum = numbers_sum(kind, body);
  if (!sum || !body["data"].contains("numbers_sha256") || body["data"]["numbers_sha256"] == *sum) return {};
  return fail(ErrorKind::malformed,
              "its numbers do not match their checksum (SHA-256): a number, quantity or unit was changed",
              place(where, "/data/numbers_sha256"),
              "restore the file; if the change is intended, remove this member");
}

Result<Document> checked(Json body, const std::string& where, std::string_view kind) {
  const auto found = kind_in(body, where, kind);
  TACTO_TRY(found);
  if (*found != kind)
    return fail(ErrorKind::malformed, fmt::format("its kind is '{}', not '{}'", *found, kind),
                place(where, "/kind"));
  auto newer = newer_version_in(body, where);
  TACTO_TRY(newer);
  const auto& rules = schema_of(kind);
  if (!rules)
    return fail(ErrorKind::internal, fmt::format("there is no usable schema for '{}'", kind), where);
  const auto list = breaches(body, *rules);
  if (!list.empty())
    return fail(ErrorKind::malformed, first_words(list), place(where, list.front().pointer),
                remedy_at(list.front().pointer, *rules));
  TACTO_TRY(check_numbers_sum(body, where, kind));
  auto unknown = unknown_members(*rules, body);
  auto extra_json = unknown_parts(*rules, body);
  return Document{std::move(body), std::move(*newer), std::move(unknown), std::move(extra_json)};
}

Result<Json> read_json(const std::string& path) {
  const auto text = read_file(path);
  TACTO_TRY(text);
  return parse_json(*text, path);
}

// JSON has no NaN and no infinity; the library would write null. `at` is the pointer of `node`, an object or
// array.
std::optional<std::string> first_not_finite(const Json& node,
                                            const Json::json_pointer& at = Json::json_pointer()) {
  for (const auto& [name, value] : node.items()) {
    if (value.is_number_float() && !std::isfinite(value.get<double>())) return (at / name).to_string();
    if (!value.is_structured()) continue;
    if (auto found = first_not_finite(value, at / name)) return found;
  }
  return std::nullopt;
}

Result<std::string> written(std::string_view kind, const Json& body, const std::string& extra_json) {
  const auto& rules = schema_of(kind);
  if (!rules) return fail(ErrorKind::internal, fmt::format("there is no usable schema for '{}'", kind));
  Json document = {{"kind", kind}, {"version", kFormatVersion}};
  for (const auto& [name, value] : body.items()) document[name] = value;
  add_unknown_parts(*rules, document, extra_json);
  if (const auto pointer = first_not_finite(document))
    return fail(ErrorKind::unsuitable, "a number that is not finite cannot be stored", *pointer);
  const auto list = breaches(document, *rules);
  if (!list.empty()) return fail(ErrorKind::unsuitable, list.front().what, list.front().pointer);
  if (const auto sum = numbers_sum(kind, document)) document["data"]["numbers_sha256"] = *sum;
  return document.dump(2) + "\n";
}

}  // namespace

Result<Document> open_document(const std::string& path, std::string_view kind) {
  auto body = read_json(path);
  return body ? checked(std::move(*body), path, kind) : forward_error(body);
}

Result<Document> parse_document(std::string_view text, const std::string& where, std::string_view kind) {
  auto body = parse_json(text, where);
  return body ? checked(std::move(*body), where, kind) : forward_error(body);
}

Result<std::string> kind_of(const std::string& path) {
  const auto body = read_json(path);
  return body ? kind_in(*body, path) : forward_error(body);
}

Result<std::vector<Violation>> violations_of(const std::string& path) {
  const auto body = read_json(path);
  TACTO_TRY(body);
  const auto kind = kind_in(*body, path);
  TACTO_TRY(kind);
  const auto& rules = schema_of(*kind);
  if (!rules)
    return fail(ErrorKind::malformed, fmt::format("'{}' is not a kind of file of tactograph", *kind),
                path + "#/kind");
  TACTO_TRY(newer_version_in(*body, path));
  return breaches(*body, *rules);
}

Result<std::string> document_text(std::string_view kind, const Json& body,
                                  const std::string& extra_json) try {
  return written(kind, body, extra_json);
} catch (const std::exception& thrown) {  // text that is not UTF-8
  return fail(ErrorKind::unsuitable,
              fmt::format("cannot be written as JSON: {}", json_reason(thrown.what())));
}

void put_text(Json& body, const char* key, const std::string& text) {
  if (!text.empty()) body[key] = text;
}

std::string text_or(const Json& body, const char* key, const std::string& fallback) {
  return body.value(key, fallback);
}

double number_or(const Json& body, const char* key, double fallback) {
  return body.value(key, fallback);
}

}  // namespace tacto::schema
