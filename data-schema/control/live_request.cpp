// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/control/live_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"
#include "data-schema/json/known_members.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<std::string_view, 14> kLiveVerbs = {"begin", "change", "keep",   "steer", "status",
                                                         "load",  "arm",    "play",   "stop",  "disarm",
                                                         "gain",  "run",    "cancel", "save"};

// The members that a request cannot do without.
std::vector<std::string_view> needed_by(LiveVerb verb) {
  if (verb == LiveVerb::begin) return {"made"};
  if (verb == LiveVerb::change) return {"made", "playing", "times"};
  if (verb == LiveVerb::load || verb == LiveVerb::save) return {"texture"};
  if (verb == LiveVerb::gain) return {"times_default"};
  if (verb == LiveVerb::run) return {"verb", "files"};
  if (verb == LiveVerb::cancel) return {"job"};
  return {};
}

template <class Value>
std::optional<Value> value_in(const Json& body, const char* name) {
  return body.contains(name) ? std::optional(body[name].get<Value>()) : std::nullopt;
}

}  // namespace

Result<LiveRequest> parse_live_request(std::string_view text) {
  const std::string where = "request";
  const auto body = parse_json(text, where, 2);
  TACTO_TRY(body);
  static const auto& kRules = schema_of("live");
  if (const auto faults = breaches(*body, *kRules); !faults.empty())
    return fail(ErrorKind::malformed, faults.front().what,
                fmt::format("{}#{}", where, faults.front().pointer),
                fmt::format("the requests are {}", fmt::join(kLiveVerbs, ", ")));
  TACTO_TRY(check_members_known(*kRules, *body, where));
  LiveRequest request;
  request.verb =
      static_cast<LiveVerb>(std::ranges::find(kLiveVerbs, text_or(*body, "request")) - kLiveVerbs.begin());
  for (const std::string_view needed : needed_by(request.verb))
    if (!body->contains(needed))
      return fail(ErrorKind::malformed, fmt::format("the request contains no '{}'", needed),
                  fmt::format("{}#/{}", where, needed), "add it");
  request.made = body->value("made", std::size_t{0});
  request.playing = body->value("playing", std::size_t{0});
  request.times = body->value("times", 1.0);
  request.id = value_in<std::int64_t>(*body, "id");
  request.texture = value_in<std::size_t>(*body, "texture");
  request.times_default = value_in<double>(*body, "times_default");
  request.job_verb = text_or(*body, "verb");
  request.files = body->value("files", request.files);
  request.inverse = value_in<std::string>(*body, "inverse");
  request.job = body->value("job", std::size_t{0});
  return request;
}

}  // namespace tacto::schema
