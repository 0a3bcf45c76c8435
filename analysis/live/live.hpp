// SPDX-License-Identifier: GPL-3.0-or-later
// Serves the page on which the textures of a folder are played.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "data-schema/base/error.hpp"
#include "playback/control/control_socket.hpp"

namespace tacto::analysis {

struct LiveOptions {
  std::string folder = ".";
  std::string transducer = "wiertlewski2011";
  std::optional<int> port;                             ///< default: the first free one of twenty
  std::string socket = playback::kUsualControlSocket;  ///< of the daemon
  std::string device = "usb:";                         ///< that the page of the device records from
};

struct LiveSummary {
  std::string address;
  std::size_t kept = 0;  ///< sessions
};

/// Serves until `stop` returns true. `announce` receives the address. Errors: not_found: the folder; as
/// read_transducer; unsuitable: the port is taken, or the program was built without the page.
schema::Result<LiveSummary> run_live(const LiveOptions& options,
                                     const std::function<void(const std::string& address)>& announce,
                                     const std::function<bool()>& stop);

}  // namespace tacto::analysis
