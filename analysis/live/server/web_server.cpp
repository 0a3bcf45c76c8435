// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/server/web_server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <libwebsockets.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <set>

namespace tacto::analysis {
namespace {

constexpr int kWaitMs = 50;
constexpr std::size_t kChunk = 32768;
constexpr std::uint16_t kMostHeader = 32768;  // bytes; beyond it libwebsockets closes without an answer
constexpr unsigned kTooLong = LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE;

// What a connection is sending or talking about. libwebsockets allocates a pointer to it.
struct Exchange {
  WebAnswer answer;
  std::size_t sent = 0;
  std::unique_ptr<WebConversation> conversation;
  std::string message;  // received so far
};
struct Place {
  Exchange* exchange;
};
struct Server {
  const WebSite& site;
  std::set<lws*> sockets;  // WebSockets that are open
};

Server& server_of(lws* wsi) {
  return *static_cast<Server*>(lws_vhost_user(lws_get_vhost(wsi)));
}

// Conversations may have texts for each other's WebSockets.
void send_what_is_to_say(const Server& server) {
  for (lws* const wsi : server.sockets) {
    const Exchange* const exchange = static_cast<Place*>(lws_wsi_user(wsi))->exchange;
    if (exchange != nullptr && !exchange->conversation->to_say.empty()) lws_callback_on_writable(wsi);
  }
}

std::string header_of(lws* wsi, lws_token_indexes token) {
  std::string text(static_cast<std::size_t>(std::max(0, lws_hdr_total_length(wsi, token))), '\0');
  if (text.empty()) return text;
  const int size = lws_hdr_copy(wsi, text.data(), static_cast<int>(text.size() + 1), token);
  text.resize(static_cast<std::size_t>(std::max(0, size)));
  return text;
}

// The part of a request behind the question mark, as it came.
std::string query_of(lws* wsi) {
  std::string query;
  char part[1024];
  for (int i = 0; lws_hdr_copy_fragment(wsi, part, sizeof part, WSI_TOKEN_HTTP_URI_ARGS, i) >= 0; ++i)
    query += (query.empty() ? "" : "&") + std::string(part);
  return query;
}

WebRequest request_of(lws* wsi, bool upgrade) {
  WebRequest request;
  request.get = lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) > 0;
  request.upgrade = upgrade;
  request.path = header_of(wsi, WSI_TOKEN_GET_URI);
  request.query = query_of(wsi);
  request.host = header_of(wsi, WSI_TOKEN_HOST);
  request.origin = header_of(wsi, WSI_TOKEN_ORIGIN);
  request.cookie = header_of(wsi, WSI_TOKEN_HTTP_COOKIE);
  return request;
}

// Returns 0, or -1 where the connection has to be closed.
int write_head(lws* wsi, const WebAnswer& answer) {
  std::vector<unsigned char> buffer(LWS_PRE + 8192);
  unsigned char *at = buffer.data() + LWS_PRE, *const end = buffer.data() + buffer.size();
  if (lws_add_http_common_headers(wsi, static_cast<unsigned>(answer.status), answer.type.c_str(),
                                  answer.body.size(), &at, end) != 0)
    return -1;
  for (const auto& [name, value] : answer.headers)
    if (lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name.c_str()),
                                    reinterpret_cast<const unsigned char*>(value.c_str()),
                                    static_cast<int>(value.size()), &at, end) != 0)
      return -1;
  return lws_finalize_write_http_header(wsi, buffer.data() + LWS_PRE, &at, end) == 0 ? 0 : -1;
}

int begin_answer(lws* wsi, Place& place, WebAnswer answer) {
  if (write_head(wsi, answer) != 0) return -1;
  if (answer.body.empty()) return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
  if (place.exchange == nullptr) place.exchange = new Exchange;
  place.exchange->answer = std::move(answer);
  place.exchange->sent = 0;
  lws_callback_on_writable(wsi);
  return 0;
}

int continue_answer(lws* wsi, Place& place) {
  Exchange* const exchange = place.exchange;
  if (exchange == nullptr || exchange->sent == exchange->answer.body.size()) return 0;
  const std::string& body = exchange->answer.body;
  const std::size_t size = std::min(kChunk, body.size() - exchange->sent);
  std::vector<unsigned char> chunk(LWS_PRE + size);
  std::copy_n(body.begin() + static_cast<std::ptrdiff_t>(exchange->sent), size, chunk.begin() + LWS_PRE);
  exchange->sent += size;
  const bool last = exchange->sent == body.size();
  if (lws_write(wsi, chunk.data() + LWS_PRE, size, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0)
    return -1;
  if (last) return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
  lws_callback_on_writable(wsi);
  return 0;
}

int close_with(lws* wsi, unsigned code, std::string reason) {
  lws_close_reason(wsi, static_cast<lws_close_status>(code), reinterpret_cast<unsigned char*>(reason.data()),
                   reason.size());
  return -1;
}

int receive(lws* wsi, Exchange& exchange, std::string_view part) {
  if (exchange.message.size() + part.size() > kMostWebMessage)
    return close_with(wsi, kTooLong, "a message has more than 16384 bytes");
  exchange.message += part;
  if (lws_remaining_packet_payload(wsi) > 0 || lws_is_final_fragment(wsi) == 0) return 0;
  const std::string message = std::exchange(exchange.message, {});
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(message.data());
  std::string reply = lws_frame_is_binary(wsi) != 0
                          ? exchange.conversation->receive_bytes({bytes, message.size()})
                          : exchange.conversation->receive_text(message);
  if (!reply.empty()) exchange.conversation->to_say.push_back(std::move(reply));
  send_what_is_to_say(server_of(wsi));
  return 0;
}

int speak(lws* wsi, std::deque<std::string>& to_say) {
  if (to_say.empty()) return 0;
  const std::string text = std::move(to_say.front());
  to_say.pop_front();
  std::vector<unsigned char> message(LWS_PRE + text.size());
  std::copy(text.begin(), text.end(), message.begin() + LWS_PRE);
  if (lws_write(wsi, message.data() + LWS_PRE, text.size(), LWS_WRITE_TEXT) < 0) return -1;
  if (!to_say.empty()) lws_callback_on_writable(wsi);
  return 0;
}

// A refused WebSocket gets a whole HTTP answer at once; its body is short.
int refuse_upgrade(lws* wsi, WebAnswer answer) {
  std::vector<unsigned char> body(LWS_PRE + answer.body.size());
  std::copy(answer.body.begin(), answer.body.end(), body.begin() + LWS_PRE);
  if (write_head(wsi, answer) != 0) return -1;
  if (lws_write(wsi, body.data() + LWS_PRE, answer.body.size(), LWS_WRITE_HTTP_FINAL) < 0) return -1;
  return 1;
}

int handle(lws* wsi, lws_callback_reasons reason, void* user, void* in, std::size_t size) {
  auto* const place = static_cast<Place*>(user);
  switch (reason) {
    case LWS_CALLBACK_HTTP:
      return begin_answer(wsi, *place, server_of(wsi).site.answer(request_of(wsi, false)));
    case LWS_CALLBACK_HTTP_WRITEABLE:
      return continue_answer(wsi, *place);
    case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE: {
      WebAnswer answer = server_of(wsi).site.answer(request_of(wsi, true));
      return answer.status == 200 ? 0 : refuse_upgrade(wsi, std::move(answer));
    }
    case LWS_CALLBACK_ESTABLISHED:
      if (place->exchange == nullptr) place->exchange = new Exchange;
      place->exchange->conversation = server_of(wsi).site.converse(request_of(wsi, true));
      server_of(wsi).sockets.insert(wsi);
      send_what_is_to_say(server_of(wsi));
      return 0;
    case LWS_CALLBACK_RECEIVE:
      return receive(wsi, *place->exchange, {static_cast<const char*>(in), size});
    case LWS_CALLBACK_SERVER_WRITEABLE:
      return speak(wsi, place->exchange->conversation->to_say);
    case LWS_CALLBACK_CLOSED:
      server_of(wsi).sockets.erase(wsi);
      [[fallthrough]];
    case LWS_CALLBACK_CLOSED_HTTP:
    case LWS_CALLBACK_HTTP_DROP_PROTOCOL:
      if (place != nullptr) {
        delete place->exchange;
        place->exchange = nullptr;
      }
      return 0;
    default:
      return 0;
  }
}

// Of a descriptor that is watched; its user data are what to call.
int handle_descriptor(lws* wsi, lws_callback_reasons reason, void*, void*, std::size_t) {
  if (reason != LWS_CALLBACK_RAW_RX_FILE && reason != LWS_CALLBACK_RAW_CLOSE_FILE) return 0;
  auto* const readable = static_cast<std::function<bool()>*>(lws_get_opaque_user_data(wsi));
  if (reason == LWS_CALLBACK_RAW_CLOSE_FILE) {
    lws_set_opaque_user_data(wsi, nullptr);
    delete readable;
    return 0;
  }
  const bool goes_on = readable != nullptr && (*readable)();
  send_what_is_to_say(server_of(wsi));
  return goes_on ? 0 : -1;
}

// libwebsockets does not report that a port is taken, so it is tried before.
bool is_free(int port) {
  const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  setsockopt(probe, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const bool bound = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(probe);
  return bound;
}

class LibwebsocketsServer final : public WebServer {
 public:
  LibwebsocketsServer(int port, const WebSite& site) : server_{site, {}} {
    lws_set_log_level(0, nullptr);
    lws_context_creation_info about{};
    about.port = port;
    about.iface = "127.0.0.1";
    about.protocols = kProtocols;
    about.user = &server_;
    about.max_http_header_data = kMostHeader;
    about.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND | LWS_SERVER_OPTION_DISABLE_IPV6;
    about.gid = static_cast<gid_t>(-1);
    about.uid = static_cast<uid_t>(-1);
    if (is_free(port)) context_ = lws_create_context(&about);
  }
  LibwebsocketsServer(const LibwebsocketsServer&) = delete;
  LibwebsocketsServer& operator=(const LibwebsocketsServer&) = delete;
  ~LibwebsocketsServer() override {
    if (context_ != nullptr) lws_context_destroy(context_);
  }
  bool listens() const { return context_ != nullptr; }

  void serve(const std::function<bool()>& stop) override {
    lws_sorted_usec_list_t timer{};
    while (!stop()) {
      lws_sul_schedule(
          context_, 0, &timer, [](lws_sorted_usec_list_t*) {}, kWaitMs * LWS_US_PER_MS);
      send_what_is_to_say(server_);
      if (lws_service(context_, 0) < 0) return;
    }
    lws_sul_cancel(&timer);
  }

  void watch(int descriptor, std::function<bool()> readable) override {
    lws_sock_file_fd_type watched{};
    watched.filefd = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
    lws* const wsi = lws_adopt_descriptor_vhost(lws_get_vhost_by_name(context_, "default"),
                                                LWS_ADOPT_RAW_FILE_DESC, watched, "descriptor", nullptr);
    if (wsi != nullptr) lws_set_opaque_user_data(wsi, new std::function<bool()>(std::move(readable)));
  }

 private:
  static constexpr lws_protocols kProtocols[] = {{"http", handle, sizeof(Place), 4096, 0, nullptr, 0},
                                                 {"descriptor", handle_descriptor, 0, 0, 0, nullptr, 0},
                                                 {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  Server server_;
  lws_context* context_ = nullptr;
};

}  // namespace

extern "C" [[gnu::visibility("default")]] WebServer* tacto_web_server(int port, const WebSite& site) {
  auto server = std::make_unique<LibwebsocketsServer>(port, site);
  return server->listens() ? server.release() : nullptr;
}

}  // namespace tacto::analysis
