// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/corpus/subject_codes.hpp"

#include <algorithm>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kInstead = "[subject]";
constexpr std::size_t kAnywhere = 3;  // characters from which a code is found within a word

// Members whose texts the program chooses: words of the schemas, dates, units.
constexpr std::string_view kFixed[] = {"kind",   "version", "format",   "quantity", "unit",
                                       "clock",  "created", "recorded", "creator",  "calibrated",
                                       "method", "filter",  "edges",    "align",    "firmware"};

char small(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_letter(char c) {
  return (small(c) >= 'a' && small(c) <= 'z') || static_cast<unsigned char>(c) >= 0x80;
}

bool continues(char a, char b) {
  return (is_digit(a) && is_digit(b)) || (is_letter(a) && is_letter(b));
}

// These may be in a code, in other spellings of it another one or none: "Jane Roe", Jane_Roe, JaneRoe.
bool separates(char c) {
  return c == ' ' || c == '_' || c == '-';
}

// Where the code ends that begins at `at`; 0 if none begins there.
std::size_t end_of(const std::string& code, const std::string& text, std::size_t at) {
  for (std::size_t i = 0; i < code.size(); ++i, ++at) {
    while (i > 0 && at < text.size() && text[at] != code[i] && separates(text[at])) ++at;
    if (at >= text.size() || text[at] != code[i]) return 0;
  }
  return at;
}

bool is_fixed(const std::string& key) {
  return key.ends_with("sha256") || key.ends_with("_date") ||
         std::ranges::find(kFixed, key) != std::end(kFixed);
}

// Strips one of the endings, if there.
void strip(std::string_view& text, std::initializer_list<std::string_view> endings) {
  for (const std::string_view ending : endings)
    if (text.ends_with(ending)) {
      text.remove_suffix(ending.size());
      return;
    }
}

class Cleaning {
 public:
  Cleaning(const NewStem& stem, const SubjectCodes& codes) : stem_(stem), codes_(codes) {}

  void clean(Json& value, const std::string& key, bool free) const {
    if (value.is_string()) {
      if (free || !is_fixed(key)) value = with_new_stem(value.get<std::string>(), stem_, codes_);
    } else if (value.is_array()) {
      for (Json& each : value) clean(each, key, free);
    } else if (value.is_object()) {
      Json kept = Json::object();
      for (auto& [name, member] : value.items()) {
        if (name == "subject") continue;
        const bool is_free = free || name.starts_with("x_");
        clean(member, name, is_free);
        kept[is_free ? codes_.without(name) : name] = std::move(member);
      }
      value = std::move(kept);
    } else if (free && codes_.in(value.dump())) {  // a number that is a code
      value = kInstead;
    }
  }

 private:
  const NewStem& stem_;
  const SubjectCodes& codes_;
};

}  // namespace

bool SubjectCodes::add(const std::string& code) {
  std::string lower, letters;
  for (const char c : code) {
    if (static_cast<unsigned char>(c) >= 0x80) return false;
    lower += small(c);
    if (!separates(c)) letters += small(c);
  }
  if (!lower.empty()) codes_.insert(letters.empty() ? lower : letters);
  return true;
}

std::string SubjectCodes::without(std::string_view text) const {
  std::string lower, result;
  for (const char c : text) lower += small(c);
  for (std::size_t at = 0; at < text.size();) {
    std::size_t longest = 0;
    for (const std::string& code : codes_) {
      const std::size_t end = end_of(code, lower, at);
      if (end <= at + longest) continue;
      const bool inside = (at > 0 && continues(lower[at - 1], lower[at])) ||
                          (end < lower.size() && continues(lower[end - 1], lower[end]));
      if (code.size() >= kAnywhere || !inside) longest = end - at;
    }
    if (longest > 0)
      result += kInstead;
    else
      result += text[at];
    at += std::max<std::size_t>(longest, 1);
  }
  return result;
}

std::string with_new_stem(const std::string& text, const NewStem& stem, const SubjectCodes& codes) {
  std::string_view name = text;
  strip(name, {".json", ".wav"});
  strip(name, {".texture", ".descriptions"});
  if (name != stem.before) {
    const std::size_t dash = name.rfind('-');  // of the stroke's number
    if (dash != std::string_view::npos && std::ranges::all_of(name.substr(dash + 1), is_digit))
      name = name.substr(0, dash);
    strip(name, {"-forward", "-backward"});
  }
  return name == stem.before ? stem.after + text.substr(name.size()) : codes.without(text);
}

Result<std::string> without_subjects(const std::string& path, const NewStem& stem,
                                     const SubjectCodes& codes) {
  const auto kind = kind_of(path);
  TACTO_TRY(kind);
  auto document = open_document(path, *kind);
  TACTO_TRY(document);
  if (!document->unknown_members.empty())
    return fail(ErrorKind::unsuitable,
                "has a member that its schema does not name, which may identify a subject",
                path + document->unknown_members.front(), "remove it, or publish with --with-subjects");
  Json& body = document->body;
  Cleaning(stem, codes).clean(body, "", false);
  body.erase("kind");
  body.erase("version");
  return document_text(*kind, body, "");
}

}  // namespace tacto::schema
