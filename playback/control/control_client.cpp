// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/control/control_client.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "data-schema/control/control.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kMostWaiting = std::size_t{256} * 1024;
constexpr std::size_t kEventsWait = std::size_t{64} * 1024;  // beyond this, events are dropped

}  // namespace

ControlClient::Descriptor::~Descriptor() {
  if (value_ >= 0) ::close(value_);
}

void ControlClient::receive() {
  char bytes[4096];
  const ssize_t got = recv(descriptor(), bytes, sizeof bytes, MSG_DONTWAIT);
  if (got > 0) in_.append(bytes, static_cast<std::size_t>(got));
  if (got > 0) lines += static_cast<std::uint64_t>(std::count(bytes, bytes + got, '\n'));
  silent_ = got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

bool ControlClient::has_line() const {
  const auto end = in_.find('\n');
  return end != std::string::npos && end < schema::kMostControlLine;
}

bool ControlClient::has_room() const {
  return in_.size() < schema::kMostControlLine;
}

std::vector<std::string> ControlClient::waiting_lines() const {
  std::vector<std::string> whole;
  std::size_t from = 0;
  for (auto end = in_.find('\n'); end != std::string::npos; end = in_.find('\n', from)) {
    whole.push_back(in_.substr(from, end - from));
    from = end + 1;
  }
  return whole;
}

std::optional<std::string> ControlClient::take_line() {
  const auto end = in_.find('\n');
  if (end == std::string::npos || end >= schema::kMostControlLine) return std::nullopt;
  std::string line = in_.substr(0, end);
  in_.erase(0, end + 1);
  return line;
}

bool ControlClient::is_endless() const {
  const auto end = in_.find('\n');
  return (end == std::string::npos ? in_.size() : end) >= schema::kMostControlLine;
}

bool ControlClient::flush() {
  while (!out_.empty()) {
    const ssize_t sent = ::send(descriptor(), out_.data(), out_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    out_.erase(0, static_cast<std::size_t>(sent));
  }
  return true;
}

bool ControlClient::send(const std::string& line) {
  out_ += line;
  return flush() && out_.size() <= kMostWaiting;
}

bool ControlClient::send_if_it_reads(const std::string& line) {
  return out_.size() + line.size() > kEventsWait ? flush() : send(line);
}

}  // namespace tacto::playback
