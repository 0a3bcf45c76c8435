// SPDX-License-Identifier: GPL-3.0-or-later
// The control socket: takes lines from clients, answers each, and tells watchers what happens (CONTROL.md).
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
#include "playback/control/control_token.hpp"
#include "playback/session/stay_watch.hpp"

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
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

/// Where all places are taken, whoever said no hello within 5 s of connecting is disconnected for the next
/// client. Where that frees none, the next clients get one of a few places that are kept for `stop` and
/// `disarm`, for 5 s at most; the one that has it longest makes room for another. Never waits for a client:
/// neither for one who is silent in the middle of a line, nor for one who does not read. One thread.
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
  /// What came until now from one client, by the `client` of its requests; without one, from all that said
  /// hello.
  LinesHeard heard_of(std::optional<std::uint64_t> client) const;
  /// 0 where nobody may come by TCP.
  int tcp_port() const { return tcp_.port; }
  std::size_t clients() const { return clients_.size(); }

 private:
  using Time = ControlClient::Time;
  ControlServer(const SocketPlace& place, int descriptor) : place_(place), descriptor_(descriptor) {}
  void let_go();
  void accept_from(int listening, bool by_tcp);
  bool has_place(bool by_tcp) const;
  bool make_place(bool by_tcp);
  void free_stop_places(bool by_tcp);
  void leave_stop_place(ControlClient& client);
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
  WrongTokens wrong_tokens_;
  std::vector<ControlClient> clients_;  // in the order in which they came
  std::uint64_t last_id_ = 0;
  std::uint64_t lines_ = 0;  // of those who said hello
  std::vector<std::string> events_;
};

}  // namespace tacto::playback
