// SPDX-License-Identifier: GPL-3.0-or-later
// The control socket: receives lines of clients, answers each, and sends events to watchers (CONTROL.md).
#pragma once

#include <poll.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/control/control.hpp"
#include "playback/control/control_client.hpp"
#include "playback/control/control_socket.hpp"
#include "playback/control/stay_watch.hpp"

namespace tacto::playback {

/// TCP on 127.0.0.1, for clients that cannot use Unix sockets.
struct LoopbackPlace {
  int port = 0;       ///< 0: any free port
  std::string token;  ///< expected in hello
};

struct SocketPlace {
  std::string path;
  std::string group;      ///< its members may connect; empty: only the daemon's user
  int most_clients = 16;  ///< at most half of them by TCP, of those that gave the token
  std::optional<LoopbackPlace> loopback;
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

/// If all places are used, a client that sent no hello within 5 s of connecting is disconnected for the next
/// one. If there is none, the next clients get one of a few places that are reserved for `stop` and `disarm`,
/// for 5 s at most; the oldest of them makes room for another. Clients by TCP that have not given the token
/// (four at most) use none of these places. A wrong token is answered after a second. The server never waits
/// for a client, neither for the end of a line nor for one that does not read. For one thread.
class ControlServer {
 public:
  /// None: answer_late() answers later; until then the next lines of that client wait. One such request at a
  /// time.
  using Answer = std::optional<schema::Result<schema::ControlFields>>;
  using Handler = std::function<Answer(const schema::ControlRequest&)>;

  /// Replaces a socket that a dead daemon left. Errors: usage: a path that is not possible for a socket, a
  /// group that does not exist; unsuitable: another daemon listens there; cannot_write.
  static schema::Result<std::unique_ptr<ControlServer>> listen(const SocketPlace& place);
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;
  ~ControlServer();

  /// Waits at most `timeout_ms` for something to do, and does it; answers at most 2 lines of each client. If
  /// a client has more, the next serve() answers them without waiting.
  void serve(int timeout_ms, const Handler& handler);
  /// Answers the client that waits for it, if it is still connected.
  void answer_late(const schema::Result<schema::ControlFields>& fields);
  /// Whether the lines of the waiting client contain a `stop` or `disarm`, which must not wait.
  bool stop_waits() const;
  /// Sent to all watchers at the end of the next serve(), because requests publish while clients are served.
  /// The event `ticks` is for those that asked for ticks.
  void publish(std::string_view event, const schema::ControlFields& fields);
  /// Whether a client asked for ticks.
  bool ticks_watched() const;
  /// Lines received so far from one client, by the `client` of its requests; without one, from all clients
  /// that sent hello.
  LinesReceived lines_received(std::optional<std::uint64_t> client) const;
  /// 0 if TCP is off.
  int tcp_port() const { return tcp_.port; }
  std::size_t clients() const { return clients_.size(); }

 private:
  using Time = ControlClient::Time;
  ControlServer(const SocketPlace& place, int descriptor) : place_(place), descriptor_(descriptor) {}
  void disconnect_expired();
  void accept_from(int listening, bool by_tcp);
  bool has_place(bool by_tcp) const;
  bool make_place(bool by_tcp);
  void free_stop_places(bool by_tcp);
  void disconnect_strangers();
  void disconnect(ControlClient& client, const schema::Error& why);
  schema::Error full() const;
  std::vector<pollfd> what_is_waited_for() const;
  std::optional<schema::Error> refusal_of(const ControlClient& client,
                                          const schema::Result<schema::ControlRequest>& request) const;
  void attend_all(const std::vector<pollfd>& waiting, const Handler& handler);
  void deliver();
  bool attend(ControlClient& client, short events, const Handler& handler);
  void take_in(ControlClient& client);
  bool answer_lines(ControlClient& client, const Handler& handler);
  std::optional<std::string> refuse(ControlClient& client, const std::string& line,
                                    const schema::ControlRequest* request);
  std::optional<std::string> answer_to(ControlClient& client, const std::string& line,
                                       const Handler& handler);
  SocketPlace place_;
  int descriptor_;
  LoopbackSocket tcp_;
  std::vector<ControlClient> clients_;  // in the order of connecting
  std::uint64_t last_id_ = 0;
  std::uint64_t lines_ = 0;  // of clients that sent hello
  struct Event {
    std::string line;
    bool ticks = false, repeated = false;  // repeated: `status` or `ticks`, of which others follow
  };
  std::vector<Event> events_;
};

}  // namespace tacto::playback
