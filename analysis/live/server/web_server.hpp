// SPDX-License-Identifier: GPL-3.0-or-later
// HTTP and WebSocket on 127.0.0.1. libwebsockets is in a module of its own, which only `tactograph live`
// loads.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tacto::analysis {

struct WebRequest {
  bool get = false;                  ///< the method is GET
  bool upgrade = false;              ///< to a WebSocket
  std::string path;                  ///< "/", "/page.js"
  std::string query;                 ///< behind the question mark
  std::string host, origin, cookie;  ///< empty where the header is missing
};

struct WebAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< names end in a colon
};

/// One WebSocket. The messages are whole.
class WebConversation {
 public:
  virtual ~WebConversation() = default;
  /// Return the text to send, or none.
  virtual std::string receive_text(std::string_view text) = 0;
  virtual std::string receive_bytes(std::span<const std::uint8_t> bytes) = 0;
  /// Texts that are sent next, in this order. Add to them on the thread of serve() only.
  std::deque<std::string> to_say;
};

/// Called on the thread of serve(). They do not throw.
struct WebSite {
  /// A WebSocket is accepted if the answer's status is 200; its body is not used then.
  std::function<WebAnswer(const WebRequest& request)> answer;
  std::function<std::unique_ptr<WebConversation>(const WebRequest& request)> converse;
};

inline constexpr std::size_t kMostWebMessage = 16384;  ///< bytes; a longer message closes the WebSocket

/// Listens on 127.0.0.1.
class WebServer {
 public:
  virtual ~WebServer() = default;
  /// Serves until `stop` returns true; it is called at least every 50 ms.
  virtual void serve(const std::function<bool()>& stop) = 0;
  /// On the thread of serve(): calls `readable` whenever the descriptor can be read, until it returns false.
  /// It uses a duplicate of the descriptor.
  virtual void watch(int descriptor, std::function<bool()> readable) = 0;
};

inline constexpr const char* kWebModule = "tactograph-web.so";
inline constexpr const char* kWebEntry = "tacto_web_server";
/// Returns null if the port is taken. The site must outlive the server; the caller deletes it.
using WebEntry = WebServer* (*)(int port, const WebSite& site);

}  // namespace tacto::analysis
