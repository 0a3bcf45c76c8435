// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/control/control_socket.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <netinet/in.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr int kBacklog = 128;
constexpr mode_t kOwnerOnly = 0600, kOwnerAndGroup = 0660;

std::string system_words(int error_number) {
  return std::generic_category().message(error_number);
}

Result<sockaddr_un> address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    return fail(ErrorKind::usage,
                fmt::format("a socket's path has 1 to {} bytes", sizeof address.sun_path - 1), path);
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

int fresh_socket() {
  return socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

bool connects(int descriptor, const sockaddr_un& address) {
  return connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

bool somebody_listens(const sockaddr_un& address) {
  const int probe = fresh_socket();
  const bool there = connects(probe, address) || errno == EAGAIN;
  ::close(probe);
  return there;
}

// Removes only a socket, never another file of that name.
void remove_stale(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode)) unlink(path.c_str());
}

Result<gid_t> group_of(const std::string& name) {
  const group* const found = getgrnam(name.c_str());
  if (found != nullptr) return found->gr_gid;
  return fail(ErrorKind::usage, fmt::format("there is no group '{}'", name), "socket_group",
              fmt::format("addgroup --system {}", name));
}

// Called before the socket listens, so that at no time others may connect.
Result<void> permit(const std::string& path, const std::string& group) {
  if (group.empty())
    return chmod(path.c_str(), kOwnerOnly) == 0 ? Result<void>()
                                                : fail(ErrorKind::cannot_write, system_words(errno), path);
  const auto id = group_of(group);
  TACTO_TRY(id);
  const bool done =
      chown(path.c_str(), static_cast<uid_t>(-1), *id) == 0 && chmod(path.c_str(), kOwnerAndGroup) == 0;
  if (done) return {};
  return fail(ErrorKind::cannot_write, "can't be given to the group: " + system_words(errno), path,
              "let the daemon's user be a member of the group");
}

Result<void> bind_and_listen(int descriptor, const sockaddr_un& address, const std::string& path,
                             const std::string& group) {
  const bool bound = bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int why = errno;
  if (!bound)
    return fail(ErrorKind::cannot_write, "the socket can't be made: " + system_words(why), path,
                why == EADDRINUSE ? "another file has that name: remove it, or name another socket"
                                  : "name a folder that the daemon's user may write in");
  if (const auto permitted = permit(path, group); !permitted) {
    unlink(path.c_str());
    return permitted;
  }
  if (::listen(descriptor, kBacklog) == 0) return {};
  return fail(ErrorKind::cannot_write, "can't listen: " + system_words(errno), path);
}

}  // namespace

Result<int> open_control_socket(const std::string& path, const std::string& group) {
  const auto address = address_of(path);
  TACTO_TRY(address);
  if (somebody_listens(*address))
    return fail(ErrorKind::unsuitable, "another daemon listens there", path,
                "stop it, or name another socket");
  remove_stale(path);
  const int descriptor = fresh_socket();
  if (descriptor < 0) return fail(ErrorKind::internal, "no socket: " + system_words(errno), path);
  const auto done = bind_and_listen(descriptor, *address, path, group);
  if (done) return descriptor;
  ::close(descriptor);
  return schema::forward_error(done);
}

std::optional<std::uint32_t> peer_user(int descriptor) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return std::nullopt;
  return peer.uid;
}

std::string user_name(std::uint32_t user) {
  constexpr std::size_t kRoom = 16384;
  std::vector<char> room(kRoom);
  passwd entry{};
  passwd* found = nullptr;
  const int failed = getpwuid_r(user, &entry, room.data(), room.size(), &found);
  return failed == 0 && found != nullptr ? std::string(entry.pw_name) : fmt::format("user {}", user);
}

Result<LoopbackSocket> open_loopback_socket(int port) {
  const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int yes = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  if (descriptor >= 0 && setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      bind(descriptor, plain, size) == 0 && ::listen(descriptor, kBacklog) == 0 &&
      getsockname(descriptor, plain, &size) == 0)
    return LoopbackSocket{descriptor, ntohs(address.sin_port)};
  const int why = errno;
  if (descriptor >= 0) ::close(descriptor);
  return fail(ErrorKind::unsuitable, "can't listen there: " + system_words(why),
              fmt::format("tcp_port {}", port), "name another port, or 0 for a free one");
}

Result<int> connect_control_socket(const std::string& path) {
  const auto address = address_of(path);
  TACTO_TRY(address);
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor >= 0 && connects(descriptor, *address)) return descriptor;
  const int why = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (why == EACCES || why == EPERM)
    return fail(ErrorKind::not_found, "this user may not connect", path,
                "become a member of the socket's group: `ls -l` names it");
  return fail(ErrorKind::not_found, "no daemon listens there: " + system_words(why), path,
              "start one: tactographd --config FILE, or systemctl start tactographd; if it has another "
              "socket, name it with --socket");
}

}  // namespace tacto::playback
