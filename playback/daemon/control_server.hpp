// SPDX-License-Identifier: GPL-3.0-or-later
// The control socket: takes lines from clients, answers each, and tells watchers what happens (CONTROL.md).
#pragma once

#include <poll.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/control.hpp"
#include "playback/daemon/control_client.hpp"
#include "playback/daemon/control_socket.hpp"

namespace tacto::playback {

/// TCP on 127.0.0.1, for clients who have no Unix sockets.
struct LoopbackPlace {
  int port = 0;       ///< 0: a free one
  std::string token;  ///< to be named in hello
};

struct SocketPlace {
  std::string path;
  std::string group;      ///< whose members may connect; empty: only the daemon's user
  int most_clients = 16;  ///< of whom at most half come by TCP
  std::optional<LoopbackPlace> loopback;
};

/// Never waits for a client: neither for one who is silent in the middle of a line, nor for one who does not
/// read. One thread.
class ControlServer {
 public:
  /// None: it comes later, by answer_late(); until then that client's next lines wait. One at a time.
  using Answer = std::optional<schema::Result<schema::ControlFields>>;
  using Handler = std::function<Answer(const schema::ControlRequest&)>;

  /// A socket that a dead daemon left is replaced. Errors: usage: a path that no socket can have, a group
  /// that does not exist; unsuitable: another daemon listens there; cannot_write.
  static schema::Result<std::unique_ptr<ControlServer>> listen(const SocketPlace& place);
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;
  ~ControlServer();

  /// Waits at most `timeout_ms` for something to do, and does it; at most 2 lines of each client.
  /// Who has more lines here gets them answered by the next serve(), which does not wait then.
  void serve(int timeout_ms, const Handler& handler);
  /// To the client who waits for it, if he is still there.
  void answer_late(const schema::Result<schema::ControlFields>& fields);
  /// Whether a `stop` or `disarm` is among the lines of the client who waits: it must not wait with them.
  bool stop_waits() const;
  /// To all who watch, at the end of the next serve(): requests publish while clients are attended.
  void publish(std::string_view event, const schema::ControlFields& fields);
  /// 0 where nobody may come by TCP.
  int tcp_port() const { return tcp_.port; }
  std::size_t clients() const { return clients_.size(); }
  std::size_t watchers() const;

 private:
  ControlServer(const SocketPlace& place, int descriptor) : place_(place), descriptor_(descriptor) {}
  void accept_all();
  void accept_tcp();
  std::size_t tcp_clients() const;
  std::vector<pollfd> what_is_waited_for() const;
  const schema::Error* refusal_of(const ControlClient& client, const schema::ControlRequest* request) const;
  void attend_all(const std::vector<pollfd>& waiting, const Handler& handler);
  void deliver();
  void refuse(int descriptor) const;
  bool attend(ControlClient& client, short events, const Handler& handler);
  bool answer_lines(ControlClient& client, const Handler& handler);
  std::optional<std::string> answer_to(ControlClient& client, const std::string& line,
                                       const Handler& handler);
  SocketPlace place_;
  int descriptor_;
  LoopbackSocket tcp_;
  std::vector<ControlClient> clients_;
  std::vector<std::string> events_;
};

}  // namespace tacto::playback
