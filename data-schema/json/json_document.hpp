// SPDX-License-Identifier: GPL-3.0-or-later
// Reads JSON documents of tactograph, checks them against their schema, and writes them. Internal to
// data-schema, because it shows JSON. Nothing here throws.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

using Json = nlohmann::ordered_json;

/// One breach of a schema: the JSON pointer ("" for the whole document) and what is wrong there.
struct Violation {
  std::string pointer;
  std::string what;
};

/// A document that fits its schema. Members that the schema requires are there and have their types.
struct Document {
  Json body;
  std::string newer_version;  ///< the file's version, if its minor version is newer than this program's
  std::vector<std::string> unknown_members = {};  ///< places of members that the schema does not name
  std::string extra_json;  ///< these members and the free ones (x_...), for document_text
};

/// What a file's value keeps of a document beyond the members that it reads.
template <class File>
void keep_unknown(const Document& document, File& file) {
  file.newer_version = document.newer_version;
  file.unknown_members = document.unknown_members;
  file.extra_json = document.extra_json;
}

/// Reads a file and checks kind, version, schema and the checksum of its numbers, if it has one. Errors:
/// not_found; malformed, with line and column or with "FILE#/json/pointer"; unsupported_version,
/// naming both versions.
Result<Document> open_document(const std::string& path, std::string_view kind);

/// The same for a text in memory; `where` names it in errors.
Result<Document> parse_document(std::string_view text, const std::string& where, std::string_view kind);

/// The `kind` in a file. Errors: not_found; malformed, if it is not JSON or has no kind.
Result<std::string> kind_of(const std::string& path);

/// Every breach of the schema of the file's own kind; empty if there is none. Errors: as open_document,
/// except the breaches themselves.
Result<std::vector<Violation>> violations_of(const std::string& path);

/// The document to write: kind and version, then `body`, then those members of `extra_json` (a document's, or
/// empty) that body lacks, then the checksum of the numbers. Two spaces of indentation, a newline at the end;
/// doubles read back to the same bits. Errors: unsuitable, by JSON pointer, where a number is not finite or
/// the schema does not allow the document.
Result<std::string> document_text(std::string_view kind, const Json& body, const std::string& extra_json);

/// body[key] = text, if there is a text: empty optional members are left out.
void put_text(Json& body, const char* key, const std::string& text);

/// An optional member, or `fallback` where it is absent. For documents that fit their schema.
std::string text_or(const Json& body, const char* key, const std::string& fallback = {});
double number_or(const Json& body, const char* key, double fallback);

}  // namespace tacto::schema
