// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>
#include <string_view>

#include "playback/control/control_token.hpp"

namespace tacto::analysis {
namespace {

constexpr std::string_view kTokenArgument = "token=";

std::string random_token() {
  std::random_device source;  // the kernel's generator
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", source());
  return token;
}

// "localhost:7230", with any port: an ssh tunnel may begin at another one.
bool is_this_computer(std::string_view host) {
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (!host.starts_with(name)) continue;
    const std::string_view rest = host.substr(name.size());
    if (rest.empty()) return true;
    return rest.size() > 1 && rest[0] == ':' &&
           rest.find_first_not_of("0123456789", 1) == std::string_view::npos;
  }
  return false;
}

// Calls back for each part of a text between separators, without blanks at its beginning.
template <class Found>
bool any_part(std::string_view text, char separator, Found found) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    std::string_view part = text.substr(0, end);
    part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
    if (found(part)) return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

WebAnswer refused(int status, std::string_view why) {
  WebAnswer answer;
  answer.status = status;
  answer.body = fmt::format("{}\n", why);
  return answer;
}

}  // namespace

LiveAccess::LiveAccess(int port)
    : port_(port), token_(random_token()), cookie_name_(fmt::format("tactograph-{}", port)) {}

std::string LiveAccess::address() const {
  return fmt::format("http://127.0.0.1:{}/?{}{}", port_, kTokenArgument, token_);
}

bool LiveAccess::has_token(const WebRequest& request) const {
  return any_part(request.query, '&', [this](std::string_view part) {
    return part.starts_with(kTokenArgument) && playback::is_token(part.substr(kTokenArgument.size()), token_);
  });
}

bool LiveAccess::has_cookie(const WebRequest& request) const {
  const std::string name = cookie_name_ + "=";
  return any_part(request.cookie, ';', [&](std::string_view part) {
    return part.starts_with(name) && playback::is_token(part.substr(name.size()), token_);
  });
}

std::optional<WebAnswer> LiveAccess::refusal(const WebRequest& request) const {
  if (!is_this_computer(request.host)) return refused(421, "this server is 127.0.0.1 or localhost only");
  if (!request.get) return refused(405, "only GET is used here");
  const bool foreign = request.origin.empty() ? request.upgrade : request.origin != "http://" + request.host;
  if (foreign) return refused(403, "another page may not use this server");
  const bool enters = request.path == "/" && has_token(request);
  if (!enters && !has_cookie(request))
    return refused(401, "open the address that tactograph live has printed: it contains a token");
  return std::nullopt;
}

void LiveAccess::let_in(const WebRequest& request, WebAnswer& answer) const {
  if (has_token(request))
    answer.headers.emplace_back(
        "set-cookie:", fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", cookie_name_, token_));
}

void add_safe_headers(WebAnswer& answer) {
  constexpr std::array<std::pair<const char*, const char*>, 7> kHeaders = {{
      {"content-security-policy:",
       "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; connect-src 'self'; "
       "img-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"cross-origin-opener-policy:", "same-origin"},
      {"cross-origin-embedder-policy:", "require-corp"},
      {"cross-origin-resource-policy:", "same-origin"},
      {"x-content-type-options:", "nosniff"},
      {"referrer-policy:", "no-referrer"},
      {"cache-control:", "no-store"},
  }};
  for (const auto& [name, value] : kHeaders)
    if (std::ranges::find(answer.headers, name, &std::pair<std::string, std::string>::first) ==
        answer.headers.end())
      answer.headers.emplace_back(name, value);
}

}  // namespace tacto::analysis
