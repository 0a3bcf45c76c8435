// SPDX-License-Identifier: GPL-3.0-or-later
// The control socket in the file system and its permissions; and the TCP socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::playback {

/// Where the daemon of this computer listens, and where its clients look for it.
inline constexpr const char* kUsualControlSocket = "/run/tactographd/control";

/// A listening Unix socket to which only its user, or also the members of a group, may connect. Replaces one
/// on which no process listens. Errors: usage: a path too long, an unknown group; unsuitable: another process
/// listens there; cannot_write.
schema::Result<int> open_control_socket(const std::string& path, const std::string& group);

struct LoopbackSocket {
  int descriptor = -1, port = 0;
};

/// A TCP socket that listens on 127.0.0.1 only; port 0 chooses a free one. Errors: unsuitable: the port is in
/// use, or not permitted for this user.
schema::Result<LoopbackSocket> open_loopback_socket(int port);

/// The user who connected to a Unix socket, as the kernel reports it; none for another socket.
std::optional<std::uint32_t> peer_user(int descriptor);
/// The user's name on this machine, or "user 1000" if there is none. May use the network (NSS).
std::string user_name(std::uint32_t user);

/// A connected socket, for clients. Errors: not_found: no process listens there, or not permitted, with what
/// to do.
schema::Result<int> connect_control_socket(const std::string& path);

}  // namespace tacto::playback
