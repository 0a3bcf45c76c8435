// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/control/live_request.hpp"

#include <fmt/format.h>

#include "data-schema/json/json_schema.hpp"
#include "data-schema/json/json_text.hpp"
#include "data-schema/json/known_members.hpp"

namespace tacto::schema {

Result<LiveRequest> parse_live_request(std::string_view text) {
  const std::string where = "request";
  const auto body = parse_json(text, where, 2);
  TACTO_TRY(body);
  static const auto& kRules = schema_of("live");
  if (const auto faults = breaches(*body, *kRules); !faults.empty())
    return fail(ErrorKind::malformed, faults.front().what,
                fmt::format("{}#{}", where, faults.front().pointer),
                R"(send {"request":"begin","made":0} or {"request":"keep"})");
  TACTO_TRY(check_members_known(*kRules, *body, where));
  LiveRequest request;
  request.verb = text_or(*body, "request") == "begin" ? LiveVerb::begin : LiveVerb::keep;
  if (request.verb == LiveVerb::begin && !body->contains("made"))
    return fail(ErrorKind::malformed, "begin contains no texture", where + "#/made", "add its number");
  request.made = body->value("made", std::size_t{0});
  return request;
}

}  // namespace tacto::schema
