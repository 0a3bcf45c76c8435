// SPDX-License-Identifier: GPL-3.0-or-later
// The address of a device on a serial port.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// The text after "tty:".
struct TtyAddress {
  std::string path;  ///< empty: the only USB serial port on which a device answers
  std::optional<unsigned> baud;
};

/// If none is named. CP2102, CH340, FTDI and debug adapters support it (core/WIRE.md).
inline constexpr unsigned kUsualBaud = 1'000'000;
/// A frame of 2128 bytes needs 0.37 s; the client waits 0.5 s for the answer to it.
inline constexpr unsigned kLeastBaud = 57'600;

/// "", "/dev/ttyACM0", "/dev/ttyACM0,baud=2000000" or "baud=2000000". Errors: usage, with the usual rates.
schema::Result<TtyAddress> parse_tty_address(std::string_view parameters);
std::string tty_uri(const TtyAddress& address);

}  // namespace tacto::firmware_host
