// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/control/control_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "playback/control/control_token.hpp"

namespace tacto::playback {
namespace {

using schema::ControlRequest;
using schema::ControlVerb;
using schema::ErrorKind;
using schema::Result;

constexpr int kLinesAtOnce = 2, kAcceptAtOnce = 128;  // few, because the device is served between two serve()
constexpr short kSomethingCame = POLLIN | POLLHUP | POLLERR;
constexpr std::chrono::seconds kGreetsWithin{5}, kStopPlaceFor{5}, kWrongTokenWaits{1};
// Beside clients accepted since the last serve().
constexpr std::ptrdiff_t kStopPlaces = 8;  // per socket
constexpr std::ptrdiff_t kStrangers = 4;   // by TCP, without the token
constexpr std::size_t kListening = 2;      // descriptors before the clients'
constexpr std::size_t kMostEvents = 1000;  // between two serve(); usual are sixty a second

const schema::Error kTooLong{ErrorKind::malformed,
                             fmt::format("a line has more than {} bytes", schema::kMostControlLine),
                             "request", "end each request with a newline"};
std::string hello_text(std::string_view more = {}) {
  return fmt::format(R"(send {{"request":"hello","version":"{}"{}}})", schema::kControlVersion, more);
}

const schema::Error kNotGreeted{ErrorKind::usage, "the first request must be hello", "request",
                                hello_text() + " first"};
const schema::Error kSilent{ErrorKind::usage, "no hello came within 5 s of connecting", "request",
                            hello_text() + " first"};
// By TCP.
const std::string kHelloWithToken =
    hello_text(R"(,"token":"...")") + ": the token is the first line of the file that tcp_token_file names";
const schema::Error kUnknown{ErrorKind::usage, "by TCP the first request must be hello with the token",
                             "request", kHelloWithToken};
const schema::Error kSilentStranger{kSilent.kind, kSilent.what, kSilent.where, kHelloWithToken};
const schema::Error kWrongToken{ErrorKind::usage, "the token is wrong", "request", kHelloWithToken};
const schema::Error kTooManyStrangers{ErrorKind::unsuitable, "too many connections have not given the token",
                                      "request", "send hello with the token as soon as it is connected"};
const schema::Error kOnlyWatches{ErrorKind::usage, "a connection that watches accepts no requests", "request",
                                 "open another connection"};

// A client that waits for an answer is still read, because a `stop` may follow.
bool wants_more(const ControlClient& client) {
  if (client.silent() || client.leaves_at) return false;
  return (client.waits_for ? client.has_room() : !client.has_line());
}

bool stops(const ControlRequest& request) {
  return request.verb == ControlVerb::stop || request.verb == ControlVerb::disarm;
}

bool is_stranger(const ControlClient& client) {
  return client.by_tcp && !client.greeted;
}

}  // namespace

Result<std::unique_ptr<ControlServer>> ControlServer::listen(const SocketPlace& place) {
  const auto opened = open_control_socket(place.path, place.group);
  TACTO_TRY(opened);
  std::unique_ptr<ControlServer> server(new ControlServer(place, *opened));
  if (!place.loopback) return server;
  const auto tcp = open_loopback_socket(place.loopback->port);
  TACTO_TRY(tcp);
  server->tcp_ = *tcp;
  return server;
}

ControlServer::~ControlServer() {
  ::close(descriptor_);
  if (tcp_.descriptor >= 0) ::close(tcp_.descriptor);
  unlink(place_.path.c_str());
}

schema::Error ControlServer::full() const {
  return {ErrorKind::unsuitable, fmt::format("{} clients are connected already", place_.most_clients),
          place_.path,
          "close one, or raise most_clients in the configuration; stop and disarm are still accepted"};
}

void ControlServer::disconnect(ControlClient& client, const schema::Error& why) {
  client.send(schema::control_error_line("", why));
  client.gone = true;
}

bool ControlServer::has_place(bool by_tcp) const {
  const auto taken = [&](bool tcp_only) {
    return std::ranges::count_if(clients_, [&](const ControlClient& one) {
      return !one.gone && !one.for_stop && !is_stranger(one) && (one.by_tcp || !tcp_only);
    });
  };
  if (by_tcp && taken(true) >= std::max(1, place_.most_clients / 2)) return false;
  return taken(false) < place_.most_clients;
}

// Finds a client by the Unix socket that sent no hello in time.
bool ControlServer::make_place(bool by_tcp) {
  if (has_place(by_tcp)) return true;
  const Time now = place_.now();
  const auto silent = std::ranges::find_if(clients_, [&](const ControlClient& one) {
    return !one.gone && !one.for_stop && !one.by_tcp && !one.greeted && now >= one.since + kGreetsWithin;
  });
  if (silent == clients_.end()) return false;
  disconnect(*silent, kSilent);
  return has_place(by_tcp);
}

// Each client in a reserved place was served at least once, so newer ones may replace it. One that sent hello
// stays longer, because its `stop` follows.
void ControlServer::free_stop_places(bool by_tcp) {
  const auto keeps = [&](const ControlClient& one) {
    return !one.gone && one.for_stop && one.by_tcp == by_tcp;
  };
  const auto keeps_silent = [&](const ControlClient& one) { return keeps(one) && !one.greeted; };
  for (auto many = std::ranges::count_if(clients_, keeps) - kStopPlaces; many > 0; --many) {
    auto leaving = std::ranges::find_if(clients_, keeps_silent);
    if (leaving == clients_.end()) leaving = std::ranges::find_if(clients_, keeps);
    disconnect(*leaving, full());
  }
}

// Any user of the machine may connect by TCP. Each stranger was served at least once, so newer ones may
// replace it: first one that waits for the answer to a wrong token, then the oldest.
void ControlServer::disconnect_strangers() {
  const auto is_here = [](const ControlClient& one) { return !one.gone && is_stranger(one); };
  const auto waits = [&](const ControlClient& one) { return is_here(one) && one.leaves_at; };
  for (auto many = std::ranges::count_if(clients_, is_here) - kStrangers; many > 0; --many) {
    auto leaving = std::ranges::find_if(clients_, waits);
    if (leaving == clients_.end()) leaving = std::ranges::find_if(clients_, is_here);
    disconnect(*leaving, kTooManyStrangers);
  }
}

void ControlServer::accept_from(int listening, bool by_tcp) {
  for (int i = 0; i < kAcceptAtOnce; ++i) {
    const int accepted = accept4(listening, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (accepted < 0) break;
    ControlClient client(accepted);
    client.id = ++last_id_;
    client.since = place_.now();
    client.by_tcp = by_tcp;
    if (!by_tcp) client.user = peer_user(accepted);
    client.for_stop = !by_tcp && !make_place(by_tcp);
    clients_.push_back(std::move(client));
  }
}

// Disconnects clients whose time has ended, and gives free places to those in reserved places.
void ControlServer::disconnect_expired() {
  const Time now = place_.now();
  for (ControlClient& one : clients_) {
    if (is_stranger(one) && !one.leaves_at && now > one.since + kGreetsWithin)
      disconnect(one, kSilentStranger);
    if (!one.gone && one.for_stop && now > one.since + kStopPlaceFor) disconnect(one, full());
    if (one.gone || !one.leaves_at || now < *one.leaves_at) continue;
    one.send(one.last_line);
    one.gone = true;
  }
  std::erase_if(clients_, [](const ControlClient& one) { return one.gone; });
  for (ControlClient& one : clients_)
    if (one.for_stop) one.for_stop = !has_place(one.by_tcp);
}

// Returns none if this client may make the request.
std::optional<schema::Error> ControlServer::refusal_of(const ControlClient& client,
                                                       const Result<ControlRequest>& request) const {
  const bool greets = request && request->verb == ControlVerb::hello;
  if (is_stranger(client)) {
    if (!request && request.error().kind == ErrorKind::unsupported_version) return request.error();
    if (!greets || request->token.empty()) return kUnknown;
    if (!is_token(request->token, place_.loopback->token)) return kWrongToken;
  }
  if (!request) return request.error();
  if (client.watching) return kOnlyWatches;
  if (!client.greeted && !greets) return kNotGreeted;
  if (client.for_stop && !greets && !stops(*request)) return full();
  return std::nullopt;
}

// Returns none if the answer is delayed, as to a wrong token.
std::optional<std::string> ControlServer::refuse(ControlClient& client, const std::string& line,
                                                 const ControlRequest* request) {
  if (is_stranger(client) && request != nullptr && !request->token.empty()) {
    client.leaves_at = place_.now() + kWrongTokenWaits;
    client.last_line = line;
    return std::nullopt;
  }
  client.disconnect_after_answer = is_stranger(client) || (client.for_stop && request != nullptr);
  return line;
}

// Returns none if the answer comes later.
std::optional<std::string> ControlServer::answer_to(ControlClient& client, const std::string& line,
                                                    const Handler& handler) {
  std::string id;
  auto request = schema::parse_control_request(line, &id);
  if (const auto refusal = refusal_of(client, request))
    return refuse(client, schema::control_error_line(id, *refusal), request ? &*request : nullptr);
  request->client = client.id;
  request->by_tcp = client.by_tcp;
  if (request->save) request->asked_by = client.user ? user_name(*client.user) : "token";
  const Answer fields = handler(*request);
  if (!fields) {
    client.waits_for = id;
    return std::nullopt;
  }
  if (!*fields) return schema::control_error_line(id, fields->error());
  if (request->verb == ControlVerb::hello) {
    const bool gets_place = client.for_stop || is_stranger(client);
    if (gets_place) client.for_stop = !make_place(client.by_tcp);
    client.greeted = true;
  }
  client.watching = client.watching || request->verb == ControlVerb::watch;
  client.watches_ticks = client.watches_ticks || request->ticks;
  return schema::control_reply_line(id, **fields);
}

void ControlServer::answer_late(const Result<schema::ControlFields>& fields) {
  const auto client =
      std::ranges::find_if(clients_, [](const ControlClient& one) { return one.waits_for.has_value(); });
  if (client == clients_.end()) return;
  const std::string id = *std::exchange(client->waits_for, std::nullopt);
  const bool here = client->send(fields ? schema::control_reply_line(id, *fields)
                                        : schema::control_error_line(id, fields.error()));
  if (!here) clients_.erase(client);
}

bool ControlServer::stop_waits() const {
  const auto is_stop = [](const std::string& line) {
    const auto request = schema::parse_control_request(line);
    return request && stops(*request);
  };
  return std::ranges::any_of(clients_, [&](const ControlClient& client) {
    return client.waits_for && std::ranges::any_of(client.waiting_lines(), is_stop);
  });
}

bool ControlServer::answer_lines(ControlClient& client, const Handler& handler) {
  for (int i = 0; i < kLinesAtOnce && !client.waits_for && !client.leaves_at; ++i) {
    const auto line = client.take_line();
    if (!line) break;
    const auto answer = answer_to(client, *line, handler);
    if (answer && !client.send(*answer)) return false;
    if (client.disconnect_after_answer) return false;
  }
  if (!client.is_endless()) return true;
  client.send(schema::control_error_line("", kTooLong));
  return false;
}

// Returns false if the client has to be removed. A client that has closed its side still gets its answers, as
// far as it reads them. More bytes are received only after the lines in the buffer are answered, which bounds
// the buffer.
bool ControlServer::attend(ControlClient& client, short events, const Handler& handler) {
  if (client.gone) return false;
  if ((events & (POLLOUT | POLLHUP | POLLERR)) != 0 && !client.flush()) return false;
  if ((events & POLLHUP) != 0 && client.waits_for) return false;
  if ((events & kSomethingCame) != 0 && wants_more(client)) take_in(client);
  if (!answer_lines(client, handler)) return false;
  return !client.silent() || client.has_line() || client.wants_to_send() || client.waits_for;
}

void ControlServer::take_in(ControlClient& client) {
  const std::uint64_t before = client.lines;
  client.receive();
  if (client.greeted) lines_ += client.lines - before;
}

// Answering one client may close another connection: connections are removed after all have been served.
void ControlServer::attend_all(const std::vector<pollfd>& waiting, const Handler& handler) {
  for (std::size_t i = 0; i < clients_.size(); ++i)
    if (!attend(clients_[i], waiting[i + kListening].revents, handler)) clients_[i].gone = true;
  std::erase_if(clients_, [](const ControlClient& one) { return one.gone; });
}

LinesReceived ControlServer::lines_received(std::optional<std::uint64_t> client) const {
  if (!client) return {true, lines_};
  const auto found = std::ranges::find(clients_, *client, &ControlClient::id);
  return found == clients_.end() ? LinesReceived{false, 0} : LinesReceived{true, found->lines};
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

// poll() does not report lines that are in a buffer already.
void ControlServer::serve(int timeout_ms, const Handler& handler) {
  disconnect_expired();
  std::vector<pollfd> waiting = what_is_waited_for();
  const bool ready = std::ranges::any_of(
      clients_, [](const ControlClient& one) { return one.has_line() && !one.waits_for && !one.leaves_at; });
  const bool some = poll(waiting.data(), waiting.size(), ready ? 0 : timeout_ms) > 0;
  if (some || ready) attend_all(waiting, handler);
  for (const bool by_tcp : {false, true}) free_stop_places(by_tcp);
  disconnect_strangers();
  if (some && (waiting[0].revents & POLLIN) != 0) accept_from(descriptor_, false);
  if (some && (waiting[1].revents & POLLIN) != 0) accept_from(tcp_.descriptor, true);
  std::erase_if(clients_, [](const ControlClient& one) { return one.gone; });
  deliver();
}

void ControlServer::publish(std::string_view event, const schema::ControlFields& fields) {
  const bool ticks = event == "ticks", repeated = ticks || event == "status";
  if (events_.size() < kMostEvents || !repeated)
    events_.push_back({schema::control_event_line(event, fields), ticks, repeated});
}

void ControlServer::deliver() {
  for (const Event& event : events_)
    std::erase_if(clients_, [&](ControlClient& client) {
      if (!(event.ticks ? client.watches_ticks : client.watching)) return false;
      return !(event.repeated ? client.send_if_it_reads(event.line) : client.send(event.line));
    });
  events_.clear();
}

bool ControlServer::ticks_watched() const {
  return std::ranges::any_of(clients_, &ControlClient::watches_ticks);
}

}  // namespace tacto::playback
