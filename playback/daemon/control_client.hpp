// SPDX-License-Identifier: GPL-3.0-or-later
// One client of the control socket, as the server keeps it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tacto::playback {

/// A request whose answer comes later.
struct LateRequest {
  std::string id;
  std::vector<std::string> passed_over;  ///< of its members: not known
};

/// Buffers of bounded size around a connected socket that never waits. Closes it.
class ControlClient {
 public:
  explicit ControlClient(int descriptor) : descriptor_(descriptor) {}
  ControlClient(ControlClient&& other) noexcept;
  ControlClient& operator=(ControlClient&& other) noexcept;
  ~ControlClient();

  int descriptor() const { return descriptor_; }
  /// Takes in what has come.
  void receive();
  /// Nothing more comes: the client has closed its side, or is gone.
  bool silent() const { return silent_; }
  /// The next whole line without its newline, if there is one.
  std::optional<std::string> take_line();
  bool has_line() const;
  /// All whole lines that are here; none is taken.
  std::vector<std::string> lines() const;
  /// Less than a longest line is here.
  bool has_room() const;
  /// More than a line may have, and still no end.
  bool is_endless() const;
  /// Sends as much as the socket takes; keeps the rest. False where the client is gone, or has not taken
  /// 256 KB.
  bool send(const std::string& line);
  /// An event: dropped, and counted, where the client does not keep up.
  bool send_event(const std::string& line);
  bool flush();
  bool wants_to_send() const { return !out_.empty(); }

  bool greeted = false, watching = false, unwelcome = false;
  std::optional<std::chrono::steady_clock::time_point> greets_by;  ///< with the token: who came by TCP
  std::optional<std::uint32_t> user;                               ///< who came by the Unix socket
  std::uint64_t dropped_events = 0;
  std::optional<LateRequest> waits_for;

 private:
  int descriptor_;
  std::string in_, out_;
  bool silent_ = false;
};

}  // namespace tacto::playback
