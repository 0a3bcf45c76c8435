// SPDX-License-Identifier: GPL-3.0-or-later
// The client's side of the control socket.
#pragma once

#include <optional>
#include <string>

#include "data-schema/control/control.hpp"

namespace tacto::playback {

class ControlConnection {
 public:
  /// Connects and sends hello. Errors: as connect_control_socket; unsupported_version; device: no answer.
  static schema::Result<ControlConnection> open(const std::string& socket);
  /// Sends hello and one request together, and disconnects. For `stop` and `disarm`, which a daemon without
  /// free places answers at once. Errors: as open() and ask().
  static schema::Result<schema::ControlFields> ask_at_once(const std::string& socket,
                                                           const schema::ControlRequest& request);
  ControlConnection(ControlConnection&& other) noexcept;
  ControlConnection& operator=(ControlConnection&& other) noexcept;
  ~ControlConnection();

  /// Sends a request and waits at most 10 s. Errors: those of the daemon; device: it disconnected or does not
  /// answer.
  schema::Result<schema::ControlFields> ask(const schema::ControlRequest& request);
  /// After `watch`: the next event; none after `timeout_ms` or a signal. Errors: device: the daemon
  /// disconnected; malformed: a line that is not an event.
  schema::Result<std::optional<schema::ControlReply>> next_event(int timeout_ms);
  const schema::ControlFields& hello() const { return hello_; }
  const std::string& socket() const { return socket_; }

 private:
  ControlConnection(std::string socket, int descriptor)
      : socket_(std::move(socket)), descriptor_(descriptor) {}
  void say(const std::string& text) const;
  schema::Result<schema::ControlFields> answer(int timeout_ms);
  schema::Result<std::optional<std::string>> line(int timeout_ms, bool signals_end_it);
  std::string socket_;
  int descriptor_;
  std::string received_;
  schema::ControlFields hello_;
};

}  // namespace tacto::playback
