// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/pty_link.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "firmware-host/tty/raw_settings.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::size_t kChunk = 4096;

// Raw before a host opens it: a terminal would return the board's bytes to the board.
FileDescriptor open_raw(const char* name) {
  FileDescriptor host_end(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  const bool raw = ::tcgetattr(host_end.get(), &settings) == 0;
  settings = raw_settings(settings);
  return raw && ::tcsetattr(host_end.get(), TCSANOW, &settings) == 0 ? std::move(host_end) : FileDescriptor();
}

}  // namespace

Result<std::unique_ptr<PtyLink>> PtyLink::open(const std::string& path) {
  FileDescriptor board_end(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
  std::array<char, 64> name{};
  const bool made = board_end.is_open() && ::grantpt(board_end.get()) == 0 &&
                    ::unlockpt(board_end.get()) == 0 &&
                    ::ptsname_r(board_end.get(), name.data(), name.size()) == 0;
  FileDescriptor host_end = made ? open_raw(name.data()) : FileDescriptor();
  if (!host_end.is_open())
    return schema::fail(ErrorKind::device, fmt::format("no pseudo-terminal: {}", std::strerror(errno)),
                        "--pty");
  if (::symlink(name.data(), path.c_str()) != 0)
    return schema::fail(ErrorKind::cannot_write,
                        fmt::format("the link to {} cannot be made: {}", name.data(), std::strerror(errno)),
                        path, "give a name that does not exist yet");
  return std::unique_ptr<PtyLink>(new PtyLink(std::move(board_end), std::move(host_end), path));
}

PtyLink::~PtyLink() {
  ::unlink(path_.c_str());
}

void PtyLink::send(std::span<const std::uint8_t> bytes) {
  to_host_.insert(to_host_.end(), bytes.begin(), bytes.end());
  write_some();
}

void PtyLink::write_some() {
  while (!to_host_.empty()) {
    std::array<std::uint8_t, kChunk> chunk;
    const std::size_t size = std::min(kChunk, to_host_.size());
    std::copy_n(to_host_.begin(), size, chunk.begin());
    const ssize_t sent = ::write(board_end_.get(), chunk.data(), size);
    if (sent <= 0) return;
    to_host_.erase(to_host_.begin(), to_host_.begin() + sent);
  }
}

void PtyLink::take_received(std::vector<std::uint8_t>& bytes) {
  std::array<std::uint8_t, kChunk> chunk;
  for (ssize_t got; (got = ::read(board_end_.get(), chunk.data(), chunk.size())) > 0;)
    bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + got);
}

void PtyLink::wait_until(Clock::time_point time) {
  for (;;) {
    write_some();
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now());
    if (left.count() <= 0) return;
    pollfd ready{board_end_.get(), static_cast<short>(to_host_.empty() ? POLLIN : POLLIN | POLLOUT), 0};
    const int events = ::poll(&ready, 1, static_cast<int>(left.count()));
    if (events <= 0 || (ready.revents & POLLOUT) == 0) return;
  }
}

}  // namespace tacto::firmware_host
