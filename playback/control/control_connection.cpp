// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/control/control_connection.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "data-schema/base/format_version.hpp"
#include "playback/control/control_socket.hpp"

namespace tacto::playback {

using schema::ControlFields;
using schema::ControlReply;
using schema::ControlRequest;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr int kAnswerMs = 10'000;
constexpr int kLoadMs = 60'000;  // a texture of 100 mm takes 1 s to load, on a slow or busy machine longer

ControlRequest hello_request() {
  ControlRequest hello;
  hello.verb = schema::ControlVerb::hello;
  hello.version = schema::kControlVersion;
  return hello;
}

}  // namespace

ControlConnection::ControlConnection(ControlConnection&& other) noexcept
    : socket_(std::move(other.socket_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      received_(std::move(other.received_)),
      hello_(std::move(other.hello_)) {}

ControlConnection& ControlConnection::operator=(ControlConnection&& other) noexcept {
  std::swap(socket_, other.socket_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(received_, other.received_);
  std::swap(hello_, other.hello_);
  return *this;
}

ControlConnection::~ControlConnection() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<ControlConnection> ControlConnection::open(const std::string& socket) {
  const auto connected = connect_control_socket(socket);
  TACTO_TRY(connected);
  ControlConnection connection(socket, *connected);
  auto answer = connection.ask(hello_request());
  TACTO_TRY(answer);
  TACTO_TRY(schema::newer_version(schema::control_text(*answer, "version"), socket, socket,
                                  schema::kControlVersion));
  connection.hello_ = std::move(*answer);
  return connection;
}

Result<ControlFields> ControlConnection::ask_at_once(const std::string& socket,
                                                     const ControlRequest& request) {
  const auto connected = connect_control_socket(socket);
  TACTO_TRY(connected);
  ControlConnection connection(socket, *connected);
  connection.say(schema::control_request_line(hello_request()) + schema::control_request_line(request));
  const auto greeted = connection.answer(kAnswerMs);
  return greeted ? connection.answer(kAnswerMs) : greeted;
}

Result<std::optional<std::string>> ControlConnection::line(int timeout_ms, bool signals_end_it) {
  for (;;) {
    if (const auto end = received_.find('\n'); end != std::string::npos) {
      std::string line = received_.substr(0, end);
      received_.erase(0, end + 1);
      return line;
    }
    pollfd waiting{descriptor_, POLLIN, 0};
    const int ready = poll(&waiting, 1, timeout_ms);
    if (ready < 0 && errno == EINTR && !signals_end_it) continue;
    if (ready <= 0) return std::optional<std::string>();
    char bytes[4096];
    const ssize_t got = recv(descriptor_, bytes, sizeof bytes, 0);
    if (got <= 0)
      return fail(ErrorKind::device, "the daemon closed the connection", socket_, "see its journal");
    received_.append(bytes, static_cast<std::size_t>(got));
  }
}

// Errors are ignored: a server that disconnects at once has sent the reason, which is read next.
void ControlConnection::say(const std::string& text) const {
  (void)::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL);
}

Result<ControlFields> ControlConnection::answer(int timeout_ms) {
  // Ctrl-C does not end it, so that the client of `ctl play --watch` can still ask for the stop.
  const auto text = line(timeout_ms, false);
  TACTO_TRY(text);
  if (!*text) return fail(ErrorKind::device, "the daemon does not answer", socket_, "see its journal");
  auto reply = schema::parse_control_reply(**text);
  TACTO_TRY(reply);
  if (!reply->ok) return tl::unexpected(reply->error);
  return std::move(reply->fields);
}

Result<ControlFields> ControlConnection::ask(const ControlRequest& request) {
  say(schema::control_request_line(request));
  return answer(request.verb == schema::ControlVerb::load ? kLoadMs : kAnswerMs);
}

Result<std::optional<ControlReply>> ControlConnection::next_event(int timeout_ms) {
  const auto text = line(timeout_ms, true);
  TACTO_TRY(text);
  if (!*text) return std::optional<ControlReply>();
  return schema::parse_control_reply(**text);
}

}  // namespace tacto::playback
