// SPDX-License-Identifier: GPL-3.0-or-later
// One client of the control socket, as the server keeps it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
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

  int descriptor() const { return descriptor_.value(); }
  /// Takes in what has come.
  void receive();
  /// Nothing more comes: the client has closed its side, or is gone.
  bool silent() const { return silent_; }
  /// The next whole line without its newline, if there is one.
  std::optional<std::string> take_line();
  bool has_line() const;
  /// All whole lines that are here; none is taken.
  std::vector<std::string> waiting_lines() const;
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

  using Time = std::chrono::steady_clock::time_point;

  std::uint64_t id = 0;
  Time since{};                       ///< when it connected
  bool by_tcp = false;                ///< it has to name the token
  std::optional<std::uint32_t> user;  ///< who came by the Unix socket
  bool greeted = false, watching = false;
  bool unwelcome = false;         ///< it is disconnected once it is answered
  bool gone = false;              ///< it is disconnected, and waits to be removed from the list
  bool for_stop = false;          ///< it has a place that is kept for `stop` and `disarm`
  std::optional<Time> leaves_at;  ///< then it is sent `last_line` and disconnected; it is not read until then
  std::string last_line;
  std::uint64_t lines = 0;  ///< that came
  std::uint64_t dropped_events = 0;
  std::optional<LateRequest> waits_for;

 private:
  // Closes what it holds.
  class Descriptor {
   public:
    explicit Descriptor(int value) : value_(value) {}
    Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
      std::swap(value_, other.value_);
      return *this;
    }
    ~Descriptor();
    int value() const { return value_; }

   private:
    int value_;
  };

  Descriptor descriptor_;
  std::string in_, out_;
  bool silent_ = false;
};

}  // namespace tacto::playback
