// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/json/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tacto::schema {
namespace {

std::string line_and_column(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte == 0 ? 0 : byte - 1);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto start = before.rfind('\n');
  return fmt::format("line {}, column {}", line, before.size() - (start == before.npos ? 0 : start + 1) + 1);
}

// Thrown through the library by the watch below, and caught by parse_json().
struct Refusal {
  std::string what, pointer, remedy;
};

/// Follows the parser's events: how deep they are, and which members each open object has.
class ParserWatch {
 public:
  explicit ParserWatch(int deepest) : deepest_(deepest) {}

  void take(int depth, Json::parse_event_t event, const Json& value) {
    using Event = Json::parse_event_t;
    if (depth > deepest_) throw Refusal{"the JSON is nested too deeply", "", ""};
    if (event == Event::object_start || event == Event::array_start) open_.emplace_back();
    if (event == Event::key) name_member(value.get_ref<const std::string&>());
    if (event == Event::object_end || event == Event::array_end) open_.pop_back();
    const bool ends_element =
        event == Event::value || event == Event::object_end || event == Event::array_end;
    if (ends_element && !open_.empty()) ++open_.back().elements;
  }

 private:
  struct Container {
    std::unordered_set<std::string> names;  // of an object's members; empty for an array
    std::string name;                       // of the current member
    std::size_t elements = 0;               // that were read
  };

  void name_member(const std::string& name) {
    if (!open_.back().names.insert(name).second)
      throw Refusal{fmt::format("the member {} appears twice", quoted_name(name)), place_of_object(),
                    "remove one of the two"};
    open_.back().name = name;
  }
  std::string place_of_object() const {
    Json::json_pointer pointer;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      if (open_[i].names.empty())
        pointer /= open_[i].elements;
      else
        pointer /= open_[i].name;
    }
    return pointer.to_string();
  }

  int deepest_;
  std::vector<Container> open_;
};

}  // namespace

std::string quoted_name(const std::string& name) {
  return name.size() <= 64 ? fmt::format("'{}'", name) : fmt::format("with a name of {} bytes", name.size());
}

// "[json.exception.parse_error.101] parse error at line 1, column 2: " goes.
std::string json_reason(const std::string& said) {
  const std::string words = said.starts_with("[json") ? said.substr(said.find("] ") + 2) : said;
  return words.starts_with("parse error") ? words.substr(words.find(": ") + 2) : words;
}

Result<Json> parse_json(std::string_view text, const std::string& where, int deepest) try {
  ParserWatch watch(deepest);
  return Json::parse(text, [&](int depth, Json::parse_event_t event, const Json& value) {
    watch.take(depth, event, value);
    return true;
  });
} catch (const Refusal& refusal) {
  const std::string place = refusal.pointer.empty() ? where : where + "#" + refusal.pointer;
  return fail(ErrorKind::malformed, refusal.what, place, refusal.remedy);
} catch (const Json::parse_error& thrown) {
  return fail(ErrorKind::malformed, "not JSON: " + json_reason(thrown.what()),
              fmt::format("{}, {}", where, line_and_column(text, thrown.byte)));
} catch (const std::exception& thrown) {
  return fail(ErrorKind::malformed, "not JSON: " + json_reason(thrown.what()), where);
}

}  // namespace tacto::schema
