// SPDX-License-Identifier: GPL-3.0-or-later
// A client of the control socket for tests: it sends and receives lines.
#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "playback/control/control_socket.hpp"

namespace tacto::tests {

inline constexpr const char* kHello = "{\"request\":\"hello\",\"version\":\"1.0\"}\n";
inline constexpr const char* kStatus = "{\"request\":\"status\"}\n";
inline constexpr const char* kLoad = "{\"request\":\"load\",\"file\":\"oak\"}\n";
inline constexpr const char* kStop = "{\"request\":\"stop\"}\n";
inline constexpr const char* kWatch = "{\"request\":\"watch\"}\n";

class SocketClient {
 public:
  explicit SocketClient(const std::string& path)
      : descriptor_(playback::connect_control_socket(path).value()) {}
  /// By TCP, on this machine.
  explicit SocketClient(int port) : descriptor_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;
  ~SocketClient() { hang_up(); }

  void say(const std::string& text) const {
    ASSERT_EQ(::send(descriptor_, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  }
  void say_no_more() const { shutdown(descriptor_, SHUT_WR); }
  void hang_up() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }
  /// Received lines that are not read yet.
  std::vector<std::string> heard() {
    char bytes[65536];
    for (ssize_t got = 1; (got = recv(descriptor_, bytes, sizeof bytes, MSG_DONTWAIT)) > 0;)
      text_.append(bytes, static_cast<std::size_t>(got));
    std::vector<std::string> lines;
    for (std::size_t end = 0; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1))
      lines.push_back(text_.substr(0, end));
    return lines;
  }

 private:
  int descriptor_;
  std::string text_;
};

}  // namespace tacto::tests
