// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/exchange/ro_crate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace tacto::schema {
namespace {

using LinkedData = nlohmann::ordered_json;

constexpr const char* kSpecification = "https://w3id.org/ro/crate/1.1";
constexpr const char* kMetadata = "ro-crate-metadata.json";

struct LicenceName {
  std::string_view name, url;
};
constexpr LicenceName kLicences[] = {{"CC0-1.0", "https://creativecommons.org/publicdomain/zero/1.0/"},
                                     {"CC-BY-4.0", "https://creativecommons.org/licenses/by/4.0/"},
                                     {"CC-BY-SA-4.0", "https://creativecommons.org/licenses/by-sa/4.0/"},
                                     {"CC-BY-NC-4.0", "https://creativecommons.org/licenses/by-nc/4.0/"},
                                     {"ODbL-1.0", "https://opendatacommons.org/licenses/odbl/1-0/"}};

std::string url_of(const std::string& licence) {
  const auto found = std::ranges::find(kLicences, std::string_view(licence), &LicenceName::name);
  if (found != std::end(kLicences)) return std::string(found->url);
  return licence.starts_with("https://") || licence.starts_with("http://") ? licence : "";
}

bool is_digit_of(char c) {
  return c >= '0' && c <= '9';
}

// ISO 7064 mod 11-2 over the first 15 digits; 10 is written X.
bool is_orcid(const std::string& text) {
  int sum = 0;
  std::string digits;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i % 5 == 4) {
      if (text[i] != '-') return false;
    } else {
      digits += text[i];
    }
  if (text.size() != 19 || !std::ranges::all_of(digits.substr(0, 15), is_digit_of)) return false;
  for (const char digit : digits.substr(0, 15)) sum = (sum + digit - '0') * 2;
  const int check = (12 - sum % 11) % 11;
  return digits.back() == (check == 10 ? 'X' : static_cast<char>('0' + check));
}

const char* format_of(const std::string& path) {
  constexpr std::pair<std::string_view, const char*> kFormats[] = {
      {".json", "application/json"}, {".wav", "audio/wav"}, {".csv", "text/csv"}};
  for (const auto& [ending, format] : kFormats)
    if (path.ends_with(ending)) return format;
  return "text/plain";
}

LinkedData reference(const std::string& id) {
  LinkedData made = LinkedData::object();
  made["@id"] = id;
  return made;
}

LinkedData file_entity(const CrateFile& file) {
  LinkedData entity{{"@id", file.path},
                    {"@type", "File"},
                    {"contentSize", fmt::format("{}", file.bytes)},
                    {"encodingFormat", format_of(file.path)}};
  if (!file.description.empty()) entity["description"] = file.description;
  return entity;
}

// File names may hold characters that an address (RFC 3986) cannot.
std::string address_of(const std::string& path) {
  std::string address;
  for (const char c : path)
    if (is_digit_of(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
        std::string_view("-._~/").find(c) != std::string_view::npos)
      address += c;
    else
      address += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return address;
}

// Adds the entities of files to the graph, and returns the references to them.
LinkedData add_files(LinkedData& graph, const std::vector<CrateFile>& files) {
  LinkedData parts = LinkedData::array();
  for (CrateFile file : files) {
    file.path = address_of(file.path);
    parts.push_back(reference(file.path));
    graph.push_back(file_entity(file));
  }
  return parts;
}

void add_people(LinkedData& graph, LinkedData& root, const Citation& citation,
                const std::vector<Creator>& creators) {
  root["creator"] = LinkedData::array();
  for (std::size_t i = 0; i < creators.size(); ++i) {
    const std::string id = creators[i].orcid.empty() ? fmt::format("#creator-{}", i + 1)
                                                     : "https://orcid.org/" + creators[i].orcid;
    root["creator"].push_back(reference(id));
    graph.push_back({{"@id", id}, {"@type", "Person"}, {"name", creators[i].name}});
  }
  root["publisher"] = reference("#publisher");
  graph.push_back({{"@id", "#publisher"}, {"@type", "Organization"}, {"name", citation.publisher}});
  const std::string licence = url_of(citation.licence);
  root["license"] = reference(licence);
  graph.push_back({{"@id", licence}, {"@type", "CreativeWork"}, {"name", citation.licence}});
}

// Reads a creator's text. Errors: usage, for an ORCID whose check digit (ISO 7064 mod 11-2) is wrong.
Result<Creator> creator_of(const std::string& text) {
  const std::size_t open = text.find(" <");
  if (open == std::string::npos) return Creator{text, ""};
  if (text.back() != '>' || open == 0)
    return fail(ErrorKind::usage, fmt::format("'{}' is not a name with an ORCID", text), "--creator",
                "write 'Doe, Jane <0000-0002-1825-0097>'");
  const std::string orcid = text.substr(open + 2, text.size() - open - 3);
  if (!is_orcid(orcid))
    return fail(ErrorKind::usage,
                fmt::format("'{}' is not an ORCID: its form or its check digit is wrong", orcid), "--creator",
                "copy it from orcid.org");
  return Creator{text.substr(0, open), orcid};
}

}  // namespace

Result<void> check_citation(const Citation& citation) {
  std::vector<std::string> missing;
  const bool unnamed =
      citation.creators.empty() ||
      std::ranges::any_of(citation.creators, [](const std::string& name) { return name.empty(); });
  for (const auto& [option, absent] : {std::pair{"--title", citation.title.empty()},
                                       {"--creator", unnamed},
                                       {"--publisher", citation.publisher.empty()},
                                       {"--year", citation.year.empty()},
                                       {"--licence", citation.licence.empty()}})
    if (absent) missing.emplace_back(option);
  if (!missing.empty())
    return fail(ErrorKind::usage,
                fmt::format("a dataset that can be cited needs {}", fmt::join(missing, ", ")), "corpus pack",
                "state them; none of them has a default");
  for (const std::string& creator : citation.creators) TACTO_TRY(creator_of(creator));
  if (citation.year.size() != 4 || !std::ranges::all_of(citation.year, is_digit_of))
    return fail(ErrorKind::usage, fmt::format("'{}' is not a year", citation.year), "--year",
                "write it as 2026");
  if (!url_of(citation.licence).empty()) return {};
  std::vector<std::string_view> names;
  for (const LicenceName& each : kLicences) names.push_back(each.name);
  return fail(ErrorKind::usage, fmt::format("'{}' is not a known licence", citation.licence), "--licence",
              fmt::format("write {}, or the address (https://...) of another one", fmt::join(names, ", ")));
}

Result<std::string> ro_crate_json(const Crate& crate) try {
  std::vector<Creator> creators;
  for (const std::string& text : crate.citation.creators) {
    auto creator = creator_of(text);
    TACTO_TRY(creator);
    creators.push_back(std::move(*creator));
  }
  LinkedData rest = LinkedData::array();
  LinkedData root{{"@id", "./"},
                  {"@type", "Dataset"},
                  {"name", crate.citation.title},
                  {"description", crate.description},
                  {"datePublished", crate.citation.year}};
  add_people(rest, root, crate.citation, creators);
  root["hasPart"] = add_files(rest, crate.files);
  for (const CrateFolder& folder : crate.folders) {
    const std::string id = address_of(folder.path);
    root["hasPart"].push_back(reference(id));
    LinkedData parts = add_files(rest, folder.files);
    rest.push_back({{"@id", id}, {"@type", "Dataset"}, {"name", folder.name}, {"hasPart", std::move(parts)}});
  }
  rest.push_back({{"@id", "#computation"},
                  {"@type", "CreateAction"},
                  {"name", "Computation of the textures"},
                  {"description", crate.steps},
                  {"instrument", reference("#program")},
                  {"result", reference("./")}});
  rest.push_back({{"@id", "#program"}, {"@type", "SoftwareApplication"}, {"name", crate.program}});
  root["mentions"] = reference("#computation");
  LinkedData graph = LinkedData::array();
  graph.push_back({{"@id", kMetadata},
                   {"@type", "CreativeWork"},
                   {"conformsTo", reference(kSpecification)},
                   {"about", reference("./")}});
  graph.push_back(std::move(root));
  for (LinkedData& entity : rest) graph.push_back(std::move(entity));
  return LinkedData{{"@context", std::string(kSpecification) + "/context"}, {"@graph", std::move(graph)}}
             .dump(2) +
         "\n";
} catch (const std::exception&) {
  return fail(ErrorKind::unsuitable, "has a name or an option that is not UTF-8", kMetadata);
}

}  // namespace tacto::schema
