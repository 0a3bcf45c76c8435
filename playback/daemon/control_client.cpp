// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/control_client.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "data-schema/control.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kMostWaiting = std::size_t{256} * 1024;
constexpr std::size_t kEventsWait = std::size_t{64} * 1024;  // beyond it, events are dropped

}  // namespace

ControlClient::ControlClient(ControlClient&& other) noexcept
    : greeted(other.greeted),
      watching(other.watching),
      unwelcome(other.unwelcome),
      greets_by(other.greets_by),
      user(other.user),
      dropped_events(other.dropped_events),
      waits_for(std::move(other.waits_for)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      in_(std::move(other.in_)),
      out_(std::move(other.out_)),
      silent_(other.silent_) {}

ControlClient& ControlClient::operator=(ControlClient&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(in_, other.in_);
  std::swap(out_, other.out_);
  silent_ = other.silent_;
  greeted = other.greeted;
  watching = other.watching;
  unwelcome = other.unwelcome;
  greets_by = other.greets_by;
  user = other.user;
  dropped_events = other.dropped_events;
  std::swap(waits_for, other.waits_for);
  return *this;
}

ControlClient::~ControlClient() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ControlClient::receive() {
  char bytes[4096];
  const ssize_t got = recv(descriptor_, bytes, sizeof bytes, MSG_DONTWAIT);
  if (got > 0) in_.append(bytes, static_cast<std::size_t>(got));
  silent_ = got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

bool ControlClient::has_line() const {
  const auto end = in_.find('\n');
  return end != std::string::npos && end < schema::kMostControlLine;
}

bool ControlClient::has_room() const {
  return in_.size() < schema::kMostControlLine;
}

std::vector<std::string> ControlClient::lines() const {
  std::vector<std::string> lines;
  std::size_t from = 0;
  for (auto end = in_.find('\n'); end != std::string::npos; end = in_.find('\n', from)) {
    lines.push_back(in_.substr(from, end - from));
    from = end + 1;
  }
  return lines;
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
    const ssize_t sent = ::send(descriptor_, out_.data(), out_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    out_.erase(0, static_cast<std::size_t>(sent));
  }
  return true;
}

bool ControlClient::send(const std::string& line) {
  out_ += line;
  return flush() && out_.size() <= kMostWaiting;
}

bool ControlClient::send_event(const std::string& line) {
  if (out_.size() + line.size() > kEventsWait) {
    ++dropped_events;
    return flush();
  }
  return send(line);
}

}  // namespace tacto::playback
