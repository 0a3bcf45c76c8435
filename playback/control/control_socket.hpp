// SPDX-License-Identifier: GPL-3.0-or-later
// The control socket in the file system, who may have it and who may connect; and the one for TCP.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::playback {

/// A listening Unix socket, that its user alone, or a group's members too, may connect to. One that nobody
/// listens on is replaced. Errors: usage: a path too long, an unknown group; unsuitable: somebody listens
/// there; cannot_write.
schema::Result<int> open_control_socket(const std::string& path, const std::string& group);

struct LoopbackSocket {
  int descriptor = -1, port = 0;
};

/// A TCP socket that listens on 127.0.0.1 only; port 0 takes a free one. Errors: unsuitable: the port is
/// taken, or not for this user.
schema::Result<LoopbackSocket> open_loopback_socket(int port);

/// The user who connected to a Unix socket, by the kernel's word; none where it is no such socket.
std::optional<std::uint32_t> peer_user(int descriptor);
/// His name on this machine; "user 1000" where he has none. May ask the network (NSS).
std::string user_name(std::uint32_t user);

/// A connected one, for clients. Errors: not_found: nobody listens there, or not permitted, with what to do.
schema::Result<int> connect_control_socket(const std::string& path);

}  // namespace tacto::playback
