// SPDX-License-Identifier: GPL-3.0-or-later
// Who may use the page: the user who has its address, in a browser on this computer, from no other page.
#pragma once

#include <optional>
#include <string>

#include "analysis/live/server/web_server.hpp"

namespace tacto::analysis {

class LiveAccess {
 public:
  /// Draws a token of 128 random bits. Cookies do not depend on the port, so the cookie's name has it.
  explicit LiveAccess(int port);

  /// "http://127.0.0.1:7230/?token=..."
  std::string address() const;
  /// Why a request is refused: 421 for another host's name, 405 for another method than GET, 403 for a
  /// foreign Origin (of a WebSocket also for none), 401 without token and cookie. None: it is allowed.
  std::optional<WebAnswer> refusal(const WebRequest& request) const;
  /// Adds the cookie to the answer of a request with the token.
  void let_in(const WebRequest& request, WebAnswer& answer) const;

 private:
  bool has_token(const WebRequest& request) const;
  bool has_cookie(const WebRequest& request) const;
  int port_;
  std::string token_, cookie_name_;
};

/// The headers of every answer: nothing from elsewhere, nothing inline, no guesses of types, no other page
/// around or beside this one. What the answer has already stays.
void add_safe_headers(WebAnswer& answer);

}  // namespace tacto::analysis
