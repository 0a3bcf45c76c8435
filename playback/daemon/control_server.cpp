// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/control_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "playback/daemon/control_token.hpp"

namespace tacto::playback {
namespace {

using schema::ControlVerb;
using schema::Fault;
using schema::Result;

constexpr int kLinesAtOnce = 2, kAcceptAtOnce = 128;  // few: between two serve() the device is looked after
constexpr short kSomethingCame = POLLIN | POLLHUP | POLLERR;
constexpr std::chrono::seconds kGreetsWithin{5};  // by TCP
constexpr std::size_t kListening = 2;             // descriptors before the clients'
constexpr std::size_t kMostEvents = 1000;         // between two serve(): ten a second are usual

const schema::Error kTooLong{Fault::malformed,
                             fmt::format("a line has more than {} bytes", schema::kMostControlLine),
                             "request", "end each request with a newline"};
const schema::Error kNotGreeted{Fault::usage, "the first request must be hello", "request",
                                R"(send {"request":"hello","version":"1.0"} first)"};
const schema::Error kUnknown{Fault::usage, "by TCP the first request must be hello with the token", "request",
                             R"(send {"request":"hello","version":"1.0","token":"..."}: the token is the )"
                             "first line of the file that tcp_token_file names"};
const schema::Error kOnlyWatches{Fault::usage, "who watches can't ask", "request", "open another connection"};

// Of who waits for an answer more is looked at, for a `stop` may be in it.
bool wants_more(const ControlClient& client) {
  return !client.silent() && (client.waits_for ? client.has_room() : !client.has_line());
}

// Newer clients may say what we don't know; who misspelt something is told.
schema::ControlFields with_passed_over(schema::ControlFields fields, const std::vector<std::string>& names) {
  if (!names.empty()) fields.emplace_back("passed_over", fmt::format("{}", fmt::join(names, ", ")));
  return fields;
}

}  // namespace

Result<std::unique_ptr<ControlServer>> ControlServer::listen(const SocketPlace& place) {
  const auto opened = open_control_socket(place.path, place.group);
  if (!opened) return schema::forward_error(opened);
  std::unique_ptr<ControlServer> server(new ControlServer(place, *opened));
  if (!place.loopback) return server;
  const auto tcp = open_loopback_socket(place.loopback->port);
  if (!tcp) return schema::forward_error(tcp);
  server->tcp_ = *tcp;
  return server;
}

ControlServer::~ControlServer() {
  ::close(descriptor_);
  if (tcp_.descriptor >= 0) ::close(tcp_.descriptor);
  unlink(place_.path.c_str());
}

std::size_t ControlServer::watchers() const {
  return static_cast<std::size_t>(std::ranges::count_if(clients_, &ControlClient::watching));
}

void ControlServer::refuse(int descriptor) const {
  const std::string line = schema::control_error_line(
      "", {Fault::unsuitable, fmt::format("{} clients are connected already", clients_.size()), place_.path,
           "close one, or raise most_clients in the configuration"});
  [[maybe_unused]] const auto told =
      ::send(descriptor, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  ::close(descriptor);
}

void ControlServer::accept_all() {
  for (int i = 0; i < kAcceptAtOnce; ++i) {
    const int accepted = accept4(descriptor_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (accepted < 0) return;
    if (clients_.size() < static_cast<std::size_t>(place_.most_clients)) {
      clients_.emplace_back(accepted);
      clients_.back().user = peer_user(accepted);
    } else {
      refuse(accepted);
    }
  }
}

std::size_t ControlServer::tcp_clients() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(clients_, [](const ControlClient& one) { return one.greets_by.has_value(); }));
}

// Anybody on the machine may connect here: so not to all places, and not for long without the token.
void ControlServer::accept_tcp() {
  const auto most = static_cast<std::size_t>(std::max(1, place_.most_clients / 2));
  for (int i = 0; i < kAcceptAtOnce; ++i) {
    const int accepted = accept4(tcp_.descriptor, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (accepted < 0) return;
    if (tcp_clients() < most && clients_.size() < static_cast<std::size_t>(place_.most_clients)) {
      clients_.emplace_back(accepted);
      clients_.back().greets_by = std::chrono::steady_clock::now() + kGreetsWithin;
    } else {
      refuse(accepted);
    }
  }
}

// Null where the request is one that this client may make.
const schema::Error* ControlServer::refusal_of(const ControlClient& client,
                                               const schema::ControlRequest* request) const {
  const bool greets = request != nullptr && request->verb == ControlVerb::hello;
  if (client.greets_by && !client.greeted && !(greets && is_token(request->token, place_.loopback->token)))
    return &kUnknown;
  if (request == nullptr) return nullptr;
  if (client.watching) return &kOnlyWatches;
  return client.greeted || greets ? nullptr : &kNotGreeted;
}

// None where the answer comes later.
std::optional<std::string> ControlServer::answer_to(ControlClient& client, const std::string& line,
                                                    const Handler& handler) {
  std::string id;
  auto request = schema::parse_control_request(line, &id);
  const schema::Error* const refusal = refusal_of(client, request ? &*request : nullptr);
  client.unwelcome = refusal == &kUnknown;
  if (refusal != nullptr) return schema::control_error_line(id, *refusal);
  if (!request) return schema::control_error_line(id, request.error());
  if (request->save) request->asked_by = client.user ? user_name(*client.user) : "token";
  const Answer fields = handler(*request);
  if (!fields) {
    client.waits_for = {id, request->passed_over};
    return std::nullopt;
  }
  if (!*fields) return schema::control_error_line(id, fields->error());
  client.greeted = client.greeted || request->verb == ControlVerb::hello;
  client.watching = client.watching || request->verb == ControlVerb::watch;
  return schema::control_reply_line(id, with_passed_over(**fields, request->passed_over));
}

void ControlServer::answer_late(const Result<schema::ControlFields>& fields) {
  const auto client =
      std::ranges::find_if(clients_, [](const ControlClient& one) { return one.waits_for.has_value(); });
  if (client == clients_.end()) return;
  const LateRequest request = *std::exchange(client->waits_for, std::nullopt);
  const bool here = client->send(
      fields ? schema::control_reply_line(request.id, with_passed_over(*fields, request.passed_over))
             : schema::control_error_line(request.id, fields.error()));
  if (!here) clients_.erase(client);
}

bool ControlServer::stop_waits() const {
  const auto stops = [](const std::string& line) {
    const auto request = schema::parse_control_request(line);
    return request && (request->verb == ControlVerb::stop || request->verb == ControlVerb::disarm);
  };
  return std::ranges::any_of(clients_, [&](const ControlClient& client) {
    return client.waits_for && std::ranges::any_of(client.lines(), stops);
  });
}

bool ControlServer::answer_lines(ControlClient& client, const Handler& handler) {
  for (int i = 0; i < kLinesAtOnce && !client.waits_for; ++i) {
    const auto line = client.take_line();
    if (!line) break;
    const auto answer = answer_to(client, *line, handler);
    if (answer && !client.send(*answer)) return false;
    if (client.unwelcome) return false;
  }
  if (!client.is_endless()) return true;
  client.send(schema::control_error_line("", kTooLong));
  return false;
}

// False where the client is to go. Who says no more is answered all the same, as far as he takes it. More is
// received only once the lines that are here are answered: so little is kept of anybody.
bool ControlServer::attend(ControlClient& client, short events, const Handler& handler) {
  if ((events & (POLLOUT | POLLHUP | POLLERR)) != 0 && !client.flush()) return false;
  if ((events & POLLHUP) != 0 && client.waits_for) return false;
  if ((events & kSomethingCame) != 0 && wants_more(client)) client.receive();
  if (!answer_lines(client, handler)) return false;
  return !client.silent() || client.has_line() || client.wants_to_send() || client.waits_for;
}

void ControlServer::attend_all(const std::vector<pollfd>& waiting, const Handler& handler) {
  std::vector<ControlClient> staying;
  staying.reserve(clients_.size() + 1);
  for (std::size_t i = 0; i < clients_.size(); ++i)
    if (attend(clients_[i], waiting[i + kListening].revents, handler))
      staying.push_back(std::move(clients_[i]));
  clients_ = std::move(staying);
}

std::vector<pollfd> ControlServer::what_is_waited_for() const {
  std::vector<pollfd> waiting{{descriptor_, POLLIN, 0}, {tcp_.descriptor, POLLIN, 0}};
  for (const ControlClient& client : clients_) {
    const int in = wants_more(client) ? POLLIN : 0;
    const int out = client.wants_to_send() ? POLLOUT : 0;
    waiting.push_back({client.descriptor(), static_cast<short>(in | out), 0});
  }
  return waiting;
}

// What a client has sent already, poll() knows nothing of.
void ControlServer::serve(int timeout_ms, const Handler& handler) {
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(clients_, [&](const ControlClient& one) {
    return one.greets_by && !one.greeted && now > *one.greets_by;
  });
  std::vector<pollfd> waiting = what_is_waited_for();
  const bool ready = std::ranges::any_of(
      clients_, [](const ControlClient& one) { return one.has_line() && !one.waits_for; });
  if (poll(waiting.data(), waiting.size(), ready ? 0 : timeout_ms) > 0 || ready) {
    attend_all(waiting, handler);
    if ((waiting[0].revents & POLLIN) != 0) accept_all();
    if ((waiting[1].revents & POLLIN) != 0) accept_tcp();
  }
  deliver();
}

void ControlServer::publish(std::string_view event, const schema::ControlFields& fields) {
  if (events_.size() < kMostEvents) events_.push_back(schema::control_event_line(event, fields));
}

void ControlServer::deliver() {
  for (const std::string& line : events_)
    std::erase_if(clients_,
                  [&](ControlClient& client) { return client.watching && !client.send_event(line); });
  events_.clear();
}

}  // namespace tacto::playback
