// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/json_schema.hpp"

#define VALIJSON_USE_EXCEPTIONS 1
#include <fmt/format.h>

#include <map>
#include <memory>
#include <mutex>

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/files/embedded_files.hpp"
#include "data-schema/json/json_text.hpp"

namespace tacto::schema {
namespace {

Json embedded_json(std::string_view name) {
  for (const EmbeddedFile& file : embedded_files())
    if (file.name == name) return Json::parse(file.content);
  return {};
}

Json expanded(const Json& node, const Json& root) {
  if (node.contains("$ref")) {
    const auto target = node["$ref"].get<std::string>();
    const auto hash = target.find('#');
    const Json document = hash == 0 ? root : embedded_json(target.substr(0, hash));
    const Json::json_pointer pointer(hash == std::string::npos ? "" : target.substr(hash + 1));
    return expanded(document.at(pointer), document);
  }
  Json copy = node;
  if (node.is_structured())
    for (auto member = copy.begin(); member != copy.end(); ++member) *member = expanded(*member, root);
  return copy;
}

// The context is "<root>", "[channels]", "[0]": another form of a JSON pointer.
Json::json_pointer pointer_of(const std::vector<std::string>& context) {
  Json::json_pointer pointer;
  for (std::size_t i = 1; i < context.size(); ++i) pointer /= context[i].substr(1, context[i].size() - 2);
  return pointer;
}

// The part of the schema for the value at `pointer`; null if the schema has none.
Json rule_at(const Json& rules, const Json::json_pointer& pointer) {
  if (pointer.empty()) return rules;
  const Json above = rule_at(rules, pointer.parent_pointer());
  if (above.contains("items")) return above["items"];
  if (above.contains("properties")) return above["properties"].value(pointer.back(), Json());
  if (above.contains("additionalProperties")) return above["additionalProperties"];
  return {};
}

std::string list_of(const Json& values) {
  if (values.is_string()) return values.get<std::string>();
  std::string list;
  for (const Json& value : values)
    list += (list.empty() ? "" : ", ") + (value.is_string() ? value.get<std::string>() : value.dump());
  return list;
}

std::string brief(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

// Names a member that may be the missing one, misspelt: one that the rule does not know, with a near name.
std::string misspelt_hint(const std::string& said, const Json& value, const Json& rule) {
  const auto from = said.find('\''), to = said.rfind('\'');
  if (from == to || !rule.is_object() || !rule.contains("properties")) return {};
  const std::vector<std::string> missing = {said.substr(from + 1, to - from - 1)};
  for (const auto& [name, of] : value.items())
    if (!rule["properties"].contains(name) && !nearest_word(name, missing).empty())
      return fmt::format("; {} is probably a misspelling of it", quoted_name(name));
  return {};
}

// Not for letters and symbols of units, which are all near each other.
std::string near_choice(const Json& value, const Json& choices) {
  if (!value.is_string() || value.get_ref<const std::string&>().size() < 3) return "";
  std::vector<std::string> words;
  for (const Json& choice : choices)
    if (choice.is_string()) words.push_back(choice);
  return did_you_mean(value.get<std::string>(), words);
}

// The validator's messages do not contain the found value and the allowed ones.
std::string explained(const std::string& said, const Json& value, const Json& rule) {
  if (said.starts_with("Missing")) return said.substr(0, said.size() - 1) + misspelt_hint(said, value, rule);
  const bool type = said.find("'type' constraint") != std::string::npos;
  if (type && rule.contains("type"))
    return fmt::format("{} is not of type {}", brief(value), list_of(rule["type"]));
  if (said.find("enum") != std::string::npos && rule.contains("enum"))
    return fmt::format("{} is not one of {}{}", brief(value), list_of(rule["enum"]),
                       near_choice(value, rule["enum"]));
  if (rule.contains("const")) return fmt::format("{} is not {}", brief(value), rule["const"].dump());
  const bool barred = said.find("'not' constraint") != std::string::npos && rule.contains("not");
  if (barred && rule["not"].contains("required"))
    return fmt::format("{} exclude each other: give only one of them", list_of(rule["not"]["required"]));
  if (barred) return fmt::format("{} is not allowed here", brief(value));
  if (said.find("regex") != std::string::npos && rule.contains("pattern"))
    return fmt::format("{} does not match {}", brief(value), rule["pattern"].dump());
  return fmt::format("{} ({})", said.substr(0, said.find_last_not_of('.') + 1), brief(value));
}

// Reported for the object around a breach that has an entry of its own.
bool repeats(const std::string& said) {
  return said.starts_with("Failed to validate");
}

std::vector<Violation> told(const valijson::ValidationResults& results, const Json& document,
                            const Json& rules) {
  std::vector<Violation> list;
  for (const auto& error : results) {
    if (repeats(error.description)) continue;
    const auto pointer = pointer_of(error.context);
    const std::string what = explained(error.description, document.at(pointer), rule_at(rules, pointer));
    list.push_back({pointer.to_string(), what});
  }
  return list;
}

using valijson::adapters::NlohmannJsonAdapter;

// The compiled schema: the validator only reads it, so threads may share it.
class Compiled {
 public:
  explicit Compiled(const Json& rules) : plain_(rules) {
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(NlohmannJsonAdapter(plain_), schema_);
  }
  const valijson::Schema& schema() const { return schema_; }

 private:
  const nlohmann::json plain_;
  valijson::Schema schema_;
};

struct KnownSchema {
  std::optional<Json> rules;
  std::unique_ptr<Compiled> compiled;
};

// Parsing and compiling takes longer than checking most documents: each schema is compiled once.
class KnownSchemas {
 public:
  const std::optional<Json>& of(std::string_view kind) {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(kind);
    if (known != known_.end()) return known->second.rules;
    const Json root = embedded_json(std::string(kind) + ".schema.json");
    if (root.is_null()) return none_;
    KnownSchema& made = known_[std::string(kind)];
    made.rules = expanded(root, root);
    return made.rules;
  }

  // Null if they are none of these.
  const Compiled* compiled(const Json& rules) {
    const std::lock_guard lock(mutex_);
    for (auto& [kind, known] : known_) {
      if (!known.rules || &*known.rules != &rules) continue;
      if (!known.compiled) known.compiled = std::make_unique<Compiled>(rules);
      return known.compiled.get();
    }
    return nullptr;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, KnownSchema, std::less<>> known_;
  const std::optional<Json> none_;
};

KnownSchemas& known_schemas() {
  static KnownSchemas schemas;
  return schemas;
}

std::vector<Violation> validated(const Json& document, const Json& rules) {
  const nlohmann::json plain_document = document;
  const Compiled* known = known_schemas().compiled(rules);
  const std::optional<Compiled> own =
      known == nullptr ? std::optional<Compiled>(std::in_place, rules) : std::nullopt;
  const valijson::Schema& schema = known != nullptr ? known->schema() : own->schema();
  valijson::ValidationResults results;
  // It keeps the regular expressions that it has compiled, which takes longer than all other checks.
  thread_local valijson::Validator validator;
  const bool sound = validator.validate(schema, NlohmannJsonAdapter(plain_document), &results);
  auto list = told(results, document, rules);
  if (!sound && list.empty()) list.push_back({"", "the document does not fit its schema"});
  return list;
}

// The ends of the range that the rule names.
std::string range_of(const Json& rule) {
  std::string range;
  const auto add = [&](const char* member, const char* words) {
    if (rule.contains(member))
      range += fmt::format("{}{} {}", range.empty() ? "" : " ", words, rule[member].dump());
  };
  add("minimum", "from");
  add("exclusiveMinimum", "above");
  add("maximum", "to");
  return range;
}

}  // namespace

const std::optional<Json>& schema_of(std::string_view kind) {
  static const std::optional<Json> kNone;
  try {
    return known_schemas().of(kind);
  } catch (const std::exception&) {
    return kNone;
  }
}

std::vector<Violation> breaches(const Json& document, const Json& rules) try {
  return validated(document, rules);
} catch (const std::exception& thrown) {
  return {{"", fmt::format("the schema cannot be used: {}", thrown.what())}};
}

std::string meaning_at(const std::string& pointer, const Json& rules) {
  const Json rule = pointer.empty() ? Json() : rule_at(rules, Json::json_pointer(pointer));
  return rule.is_object() ? rule.value("description", "") : "";
}

std::string remedy_at(const std::string& pointer, const Json& rules) {
  const Json rule = rule_at(rules, Json::json_pointer(pointer));
  const std::string range = rule.is_object() ? range_of(rule) : "", meaning = meaning_at(pointer, rules);
  return range.empty() || meaning.empty() ? range : meaning + "; " + range;
}

}  // namespace tacto::schema
