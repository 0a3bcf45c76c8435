// SPDX-License-Identifier: GPL-3.0-or-later
// The server's state of one client of the control socket.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tacto::playback {

/// Bounded buffers around a connected socket whose calls never block. The destructor closes the socket.
class ControlClient {
 public:
  explicit ControlClient(int descriptor) : descriptor_(descriptor) {}

  int descriptor() const { return descriptor_.value(); }
  /// Reads the bytes that have arrived.
  void receive();
  /// Whether no more bytes can come: the client has closed its side or has disconnected.
  bool silent() const { return silent_; }
  /// Removes and returns the next whole line, without its newline, if there is one.
  std::optional<std::string> take_line();
  bool has_line() const;
  /// All whole lines in the buffer; they stay there.
  std::vector<std::string> waiting_lines() const;
  /// Whether the buffer holds less than the longest line.
  bool has_room() const;
  /// Whether the buffer holds a line that is too long, without its end.
  bool is_endless() const;
  /// Sends as much as the socket accepts and keeps the rest. False if the client has disconnected, or more
  /// than 256 KB are unsent.
  bool send(const std::string& line);
  /// As send(), but dropped if 64 KB are unsent.
  bool send_if_it_reads(const std::string& line);
  bool flush();
  bool wants_to_send() const { return !out_.empty(); }

  using Time = std::chrono::steady_clock::time_point;

  std::uint64_t id = 0;
  Time since{};                       ///< when it connected
  bool by_tcp = false;                ///< it has to give the token
  std::optional<std::uint32_t> user;  ///< of a client by the Unix socket
  bool greeted = false, watching = false;
  bool watches_ticks = false;            ///< if it is watching
  bool disconnect_after_answer = false;  ///< it is disconnected after its answer
  bool gone = false;                     ///< it is disconnected and waits for its removal from the list
  bool for_stop = false;                 ///< it has a place that is reserved for `stop` and `disarm`
  std::optional<Time> leaves_at;         ///< time to send `last_line` and disconnect; not read until then
  std::string last_line;
  std::uint64_t lines = 0;               ///< received
  std::optional<std::string> waits_for;  ///< the id of a request that is answered later

 private:
  // Closes its file descriptor.
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
