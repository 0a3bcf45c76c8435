// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "data-schema/base/format_version.hpp"
#include "data-schema/control/control.hpp"
#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/scene/playback_choices_json.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<std::string_view, 13> kControlVerbs = {"hello",  "load",   "arm",  "play", "stop",
                                                            "disarm", "gain",   "set",  "move", "raise",
                                                            "mark",   "status", "watch"};
constexpr int kDeepestRequest = 3;
constexpr std::string_view kRequestWhere = "request";

// A member that appears twice is named; everything else that is not a request gets the same answer.
Result<Json> request_json(std::string_view line) {
  auto body = parse_json(line, std::string(kRequestWhere), kDeepestRequest);
  if (body || !body.error().remedy.empty()) return body;
  return fail(ErrorKind::malformed, "the line is not a JSON object", std::string(kRequestWhere),
              R"(send lines such as {"request":"status"})");
}

std::string id_in(const Json& body) try {
  if (!body.is_object() || !body.contains("id")) return {};
  const Json& id = body["id"];
  return id.is_string() || id.is_number() ? id.dump() : std::string();
} catch (const std::exception&) {  // not UTF-8
  return {};
}

tl::unexpected<Error> bad_member(const char* member, std::string what, std::string remedy) {
  return fail(ErrorKind::malformed, std::move(what), fmt::format("{}#/{}", kRequestWhere, member),
              std::move(remedy));
}

// The description of a member; without a member the request itself is wrong.
std::string remedy_for(const std::string& pointer, const Json& rules) {
  if (auto range = remedy_at(pointer, rules); !range.empty()) return range;
  if (auto meaning = meaning_at(pointer, rules); !meaning.empty()) return meaning;
  return fmt::format("the requests are {}", fmt::join(kControlVerbs, ", "));
}

Result<void> check_version_of(const std::string& version) {
  const auto known =
      newer_version(version, "the client", fmt::format("{}#/version", kRequestWhere), kControlVersion);
  if (known || known.error().kind != ErrorKind::unsupported_version)
    return known ? Result<void>() : forward_error(known);
  return fail(ErrorKind::unsupported_version,
              fmt::format("the client uses version {} of the control protocol, this daemon version {}",
                          version, kControlVersion),
              std::string(kRequestWhere), "use the tactograph that came with the daemon");
}

// The code points of a text in UTF-8.
std::u32string code_points(std::string_view utf8) {
  std::u32string points;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U && !points.empty())
      points.back() = points.back() << 6U | (byte & 0x3FU);
    else
      points.push_back(byte < 0x80   ? byte
                       : byte < 0xE0 ? byte & 0x1FU
                       : byte < 0xF0 ? byte & 0x0FU
                                     : byte & 0x07U);
  }
  return points;
}

std::size_t utf8_bytes(std::u32string_view points) {
  std::size_t bytes = 0;
  for (const char32_t point : points)
    bytes += point < 0x80 ? 1U : point < 0x800 ? 2U : point < 0x10000 ? 3U : 4U;
  return bytes;
}

bool is_within(char32_t point, char32_t first, char32_t last) {
  return first <= point && point <= last;
}

// Separators of words (Unicode's category Zs), and U+200B and U+FEFF, which have no width.
bool is_blank(char32_t point) {
  return std::u32string_view(U" \u00A0\u1680\u202F\u205F\u3000\uFEFF").find(point) !=
             std::u32string_view::npos ||
         is_within(point, 0x2000, 0x200B);
}

// The sets C0 and C1, separators of lines and paragraphs, and the controls of the writing direction.
bool is_control(char32_t point) {
  return point < 0x20 || is_within(point, 0x7F, 0x9F) || point == 0x61C || is_within(point, 0x200E, 0x200F) ||
         is_within(point, 0x2028, 0x202E) || is_within(point, 0x2066, 0x2069);
}

// The text of a mark without blanks at its ends.
Result<std::string> mark_text(std::string_view text) {
  const std::u32string points = code_points(text);
  if (const auto control = std::ranges::find_if(points, is_control); control != points.end())
    return bad_member("text",
                      fmt::format("character {} of the text is the control character U+{:04X}",
                                  control - points.begin() + 1, static_cast<std::uint32_t>(*control)),
                      "leave it out: a mark is one line of characters that are shown");
  const auto first = std::ranges::find_if_not(points, is_blank);
  if (first == points.end())
    return bad_member("text", "the mark has no text", R"(give one, such as "trial 1")");
  const auto last = std::find_if_not(points.rbegin(), points.rend(), is_blank).base();
  const std::size_t from = utf8_bytes({points.begin(), first});
  return std::string(text.substr(from, utf8_bytes({first, last})));
}

Result<void> check_members(const ControlRequest& request) {
  if (request.verb == ControlVerb::hello && request.version.empty())
    return bad_member("version", "hello contains no version",
                      fmt::format(R"(add "version":"{}")", kControlVersion));
  if (request.verb == ControlVerb::load && request.file.empty())
    return bad_member("file", "load contains no file", "add the file name of a texture or scene");
  if (request.verb == ControlVerb::set && (request.number.empty() || !request.value))
    return bad_member("number", "set needs a number and its value",
                      R"(add "number":"bench.0.stiffness_n_per_m","value":100)");
  if ((request.verb == ControlVerb::move || request.verb == ControlVerb::raise) && request.patch.empty())
    return bad_member("patch", "the request names no patch", R"(add the name of a patch of the scene)");
  if (request.verb == ControlVerb::move && !(request.x_m && request.y_m))
    return bad_member(request.x_m ? "y_m" : "x_m", "move needs the place of the patch's centre",
                      R"(add "x_m":0.01,"y_m":0.02)");
  const int gains =
      request.gain.has_value() + request.gain_m_per_n.has_value() + request.times_default.has_value();
  if (request.verb == ControlVerb::gain && gains == 0)
    return bad_member("gain", "gain contains no gain",
                      R"(add a factor, as in "times_default":0.5, or "gain_m_per_n":0.0005)");
  if (gains > 1)
    return bad_member("gain", "the request contains several gains",
                      "send one of gain, gain_m_per_n and times_default");
  if (request.verb == ControlVerb::hello) return check_version_of(request.version);
  return {};
}

// A member of another request was meant for that request: it must not be ignored, because it may be a limit.
Result<void> check_taken(const Json& body, ControlVerb verb) {
  constexpr std::array<std::pair<const char*, ControlVerb>, 17> kTakenBy = {
      {{"version", ControlVerb::hello},
       {"token", ControlVerb::hello},
       {"file", ControlVerb::load},
       {"at_m", ControlVerb::load},
       {"ends", ControlVerb::load},
       {"fade_s", ControlVerb::load},
       {"playback", ControlVerb::load},
       {"while_connected", ControlVerb::arm},
       {"dead_man_s", ControlVerb::arm},
       {"gain", ControlVerb::gain},
       {"save", ControlVerb::gain},
       {"number", ControlVerb::set},
       {"value", ControlVerb::set},
       {"x_m", ControlVerb::move},
       {"y_m", ControlVerb::move},
       {"text", ControlVerb::mark},
       {"ticks", ControlVerb::watch}}};
  const auto word = [](ControlVerb of) { return kControlVerbs[static_cast<std::size_t>(of)]; };
  for (const auto& [name, taker] : kTakenBy)
    if (body.contains(name) && verb != taker)
      return bad_member(name, fmt::format("'{}' does not accept '{}'", word(verb), name),
                        fmt::format("send it with '{}'", word(taker)));
  struct OfTwo {
    const char* name;
    ControlVerb one, other;
  };
  for (const auto& [name, one, other] : {OfTwo{"gain_m_per_n", ControlVerb::load, ControlVerb::gain},
                                         {"times_default", ControlVerb::load, ControlVerb::gain},
                                         {"over_s", ControlVerb::set, ControlVerb::move},
                                         {"patch", ControlVerb::move, ControlVerb::raise}})
    if (body.contains(name) && verb != one && verb != other)
      return bad_member(name, fmt::format("'{}' does not accept '{}'", word(verb), name),
                        fmt::format("send it with '{}' or '{}'", word(one), word(other)));
  return {};
}

std::optional<double> asked_number(const Json& body, const char* name) {
  return body.contains(name) ? std::optional(body[name].get<double>()) : std::nullopt;
}

ControlRequest request_of(const Json& body) {
  ControlRequest request;
  request.verb = static_cast<ControlVerb>(std::ranges::find(kControlVerbs, text_or(body, "request")) -
                                          kControlVerbs.begin());
  request.id_json = id_in(body);
  request.version = text_or(body, "version");
  request.token = text_or(body, "token");
  request.file = text_or(body, "file");
  request.at_m = asked_number(body, "at_m");
  request.gain_m_per_n = asked_number(body, "gain_m_per_n");
  request.times_default = asked_number(body, "times_default");
  request.fade_s = asked_number(body, "fade_s");
  request.playback = playback_choices_in(body);
  request.while_connected = body.value("while_connected", false);
  request.dead_man_s = asked_number(body, "dead_man_s");
  request.gain = asked_number(body, "gain");
  request.save = body.value("save", false);
  request.number = text_or(body, "number");
  request.value = asked_number(body, "value");
  request.patch = text_or(body, "patch");
  request.x_m = asked_number(body, "x_m");
  request.y_m = asked_number(body, "y_m");
  request.over_s = asked_number(body, "over_s");
  request.text = text_or(body, "text");
  request.ticks = body.value("ticks", false);
  for (const TextureEnds ends : {TextureEnds::stop, TextureEnds::mirror, TextureEnds::loop})
    if (text_or(body, "ends") == to_string(ends)) request.ends = ends;
  return request;
}

Json value_json(const ControlValue& value) {
  return std::visit([](const auto& plain) { return Json(plain); }, value);
}

bool is_sendable(const ControlValue& value) {
  const auto* number = std::get_if<double>(&value);
  return number == nullptr || std::isfinite(*number);
}

// A system text that is not UTF-8 must not make an answer fail.
std::string line_of(const Json& body) {
  return body.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void put_fields(Json& body, const ControlFields& fields) {
  for (const auto& [name, value] : fields)
    if (is_sendable(value)) body[name] = value_json(value);
}

Json begun(const std::string& id_json) {
  Json body = Json::object();
  if (!id_json.empty()) body["id"] = Json::parse(id_json, nullptr, false);
  return body;
}

std::optional<ControlValue> value_from(const Json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return std::nullopt;
  std::vector<double> numbers;
  for (const Json& number : value)
    if (number.is_number()) numbers.push_back(number.get<double>());
  return numbers;
}

ControlReply reply_from(const Json& body) {
  ControlReply reply;
  reply.ok = body.value("ok", false);
  reply.event = text_or(body, "event");
  for (const auto& [name, value] : body.items())
    if (auto plain = value_from(value)) reply.fields.emplace_back(name, std::move(*plain));
  if (!body.contains("error")) return reply;
  const Json& error = body["error"];
  reply.error = {static_cast<ErrorKind>(error.value("fault", 0)), text_or(error, "what"),
                 text_or(error, "where"), text_or(error, "remedy")};
  return reply;
}

}  // namespace

Result<ControlRequest> parse_control_request(std::string_view line, std::string* id_json) {
  const auto body = request_json(line);
  TACTO_TRY(body);
  if (id_json != nullptr) *id_json = id_in(*body);
  static const auto& kRules = schema_of("control");
  const auto faults = breaches(*body, *kRules);
  if (!faults.empty())
    return fail(ErrorKind::malformed, faults.front().what,
                fmt::format("{}#{}", kRequestWhere, faults.front().pointer),
                remedy_for(faults.front().pointer, *kRules));
  TACTO_TRY(check_members_known(*kRules, *body, std::string(kRequestWhere)));
  ControlRequest request = request_of(*body);
  TACTO_TRY(check_taken(*body, request.verb));
  TACTO_TRY(check_members(request));
  if (request.verb != ControlVerb::mark) return request;
  auto text = mark_text(request.text);
  TACTO_TRY(text);
  request.text = std::move(*text);
  return request;
}

std::string control_request_line(const ControlRequest& request) {
  Json body = begun(request.id_json);
  body["request"] = kControlVerbs[static_cast<std::size_t>(request.verb)];
  put_text(body, "version", request.version);
  put_text(body, "file", request.file);
  if (request.at_m) body["at_m"] = *request.at_m;
  if (request.gain_m_per_n) body["gain_m_per_n"] = *request.gain_m_per_n;
  if (request.times_default) body["times_default"] = *request.times_default;
  if (request.ends) body["ends"] = to_string(*request.ends);
  if (request.fade_s) body["fade_s"] = *request.fade_s;
  if (Json playback = playback_choices_body(request.playback); !playback.empty()) body["playback"] = playback;
  if (request.while_connected) body["while_connected"] = true;
  if (request.dead_man_s) body["dead_man_s"] = *request.dead_man_s;
  if (request.gain) body["gain"] = *request.gain;
  if (request.save) body["save"] = true;
  put_text(body, "number", request.number);
  if (request.value) body["value"] = *request.value;
  put_text(body, "patch", request.patch);
  if (request.x_m) body["x_m"] = *request.x_m;
  if (request.y_m) body["y_m"] = *request.y_m;
  if (request.over_s) body["over_s"] = *request.over_s;
  put_text(body, "text", request.text);
  if (request.ticks) body["ticks"] = true;
  return line_of(body);
}

std::string control_reply_line(const std::string& id_json, const ControlFields& fields) {
  Json body = begun(id_json);
  body["ok"] = true;
  put_fields(body, fields);
  return line_of(body);
}

std::string control_error_line(const std::string& id_json, const Error& error) {
  Json body = begun(id_json);
  body["ok"] = false;
  body["error"] = {{"fault", static_cast<int>(error.kind)},
                   {"what", error.what},
                   {"where", error.where},
                   {"remedy", error.remedy}};
  return line_of(body);
}

std::string control_event_line(std::string_view name, const ControlFields& fields) {
  Json body = {{"event", name}};
  put_fields(body, fields);
  return line_of(body);
}

Result<ControlReply> parse_control_reply(std::string_view line) try {
  const auto body = parse_json(line, "reply");
  if (body && body->is_object()) return reply_from(*body);
  return fail(ErrorKind::malformed, body ? "the reply of the daemon is not a JSON object" : body.error().what,
              "reply", "check that the server at this address is tactographd");
} catch (const std::exception&) {  // a member of another type than ours has
  return fail(ErrorKind::malformed, "the reply is not one of tactographd", "reply",
              "check that the server at this address is tactographd");
}

double control_number(const ControlFields& fields, std::string_view name, double fallback) {
  for (const auto& [key, value] : fields) {
    if (key != name) continue;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    if (const auto* count = std::get_if<std::int64_t>(&value)) return static_cast<double>(*count);
  }
  return fallback;
}

std::string control_text(const ControlFields& fields, std::string_view name) {
  for (const auto& [key, value] : fields)
    if (const auto* text = std::get_if<std::string>(&value); text != nullptr && key == name) return *text;
  return {};
}

}  // namespace tacto::schema
