// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/json_document.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "data-schema/files/files.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"
#include "data-schema/json/known_members.hpp"

namespace tacto::schema {
namespace {

std::string place(const std::string& where, const std::string& pointer) {
  return pointer.empty() ? where : where + "#" + pointer;
}

Result<std::string> kind_in(const Json& body, const std::string& where) {
  const bool named = body.is_object() && body.contains("kind") && body["kind"].is_string();
  if (!named) return fail(ErrorKind::malformed, "JSON without a `kind`: not a file of tactograph", where);
  return body["kind"].get<std::string>();
}

struct Version {
  int major = 0, minor = 0;
};

std::optional<Version> version_from(std::string_view text) {
  Version version;
  const char* const end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.major);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
  if (minor.ec != std::errc() || minor.ptr != end) return std::nullopt;
  return version;
}

struct KindVersion {
  std::string_view kind, version;
};
constexpr KindVersion kNewerKinds[] = {{"scene", "1.1"},     // 1.1: patches of force layers
                                       {"session", "1.2"}};  // 1.1: measured displacement; 1.2: forces

/// The file's version if its minor version is newer than this program's, else "".
Result<std::string> newer_version(const Json& body, std::string_view kind, const std::string& where) {
  const std::string text =
      body.contains("version") && body["version"].is_string() ? body["version"].get<std::string>() : "";
  const auto version = version_from(text);
  if (!version)
    return fail(ErrorKind::malformed, "`version` is not \"major.minor\"", place(where, "/version"));
  const Version ours = *version_from(version_of_kind(kind));
  if (version->major != ours.major)
    return fail(ErrorKind::unsupported_version,
                fmt::format("its format has version {}, this program reads {}.x", text, ours.major), where,
                version->major > ours.major ? "use a newer tactograph" : "");
  return version->minor > ours.minor ? text : "";
}

Result<Document> checked(Json body, const std::string& where, std::string_view kind) {
  const auto found = kind_in(body, where);
  TACTO_TRY(found);
  if (*found != kind)
    return fail(ErrorKind::malformed, fmt::format("its kind is '{}', not '{}'", *found, kind),
                place(where, "/kind"));
  auto newer = newer_version(body, kind, where);
  TACTO_TRY(newer);
  const auto& rules = schema_of(kind);
  if (!rules)
    return fail(ErrorKind::internal, fmt::format("there is no usable schema for '{}'", kind), where);
  const auto list = breaches(body, *rules);
  if (!list.empty())
    return fail(ErrorKind::malformed, list.front().what, place(where, list.front().pointer),
                remedy_at(list.front().pointer, *rules));
  auto unknown = unknown_members(*rules, body);
  auto extra_json = unknown_parts(*rules, body);
  return Document{std::move(body), std::move(*newer), std::move(unknown), std::move(extra_json)};
}

Result<Json> read_json(const std::string& path) {
  const auto text = read_file(path);
  TACTO_TRY(text);
  return parse_json(*text, path);
}

// JSON has no NaN and no infinity; the library would write null.
std::optional<std::string> first_not_finite(const Json& node) {
  const Json flat = node.flatten();  // a variable: items() would outlive a temporary
  for (const auto& [pointer, value] : flat.items())
    if (value.is_number_float() && !std::isfinite(value.get<double>())) return pointer;
  return std::nullopt;
}

Result<std::string> written(std::string_view kind, const Json& body, const std::string& extra_json) {
  const auto& rules = schema_of(kind);
  if (!rules) return fail(ErrorKind::internal, fmt::format("there is no usable schema for '{}'", kind));
  Json document = {{"kind", kind}, {"version", version_of_kind(kind)}};
  for (const auto& [name, value] : body.items()) document[name] = value;
  add_unknown_parts(*rules, document, extra_json);
  if (const auto pointer = first_not_finite(document))
    return fail(ErrorKind::unsuitable, "a number that is not finite cannot be stored", *pointer);
  const auto list = breaches(document, *rules);
  if (!list.empty()) return fail(ErrorKind::unsuitable, list.front().what, list.front().pointer);
  return document.dump(2) + "\n";
}

}  // namespace

std::string_view version_of_kind(std::string_view kind) {
  for (const KindVersion& newer : kNewerKinds)
    if (newer.kind == kind) return newer.version;
  return kVersion;
}

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
  TACTO_TRY(newer_version(*body, *kind, path));
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
