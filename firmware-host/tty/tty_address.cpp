// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/tty/tty_address.hpp"

#include <fmt/format.h>
#include <termios.h>

#include <charconv>

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::string_view kBaudKey = "baud=";

Result<unsigned> parse_baud(std::string_view text) {
  unsigned baud = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), baud);
  const bool number = read.ec == std::errc() && read.ptr == text.data() + text.size();
  termios settings{};
  if (number && baud >= kLeastBaud && ::cfsetspeed(&settings, baud) == 0) return baud;
  return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a baud rate that can be used", text),
                      "device", "use 115200, 230400, 460800, 921600, 1000000, 2000000, 3000000 or 4000000");
}

}  // namespace

// PATH, or PATH,baud=N, or baud=N; the path may be empty.
Result<TtyAddress> parse_tty_address(std::string_view parameters) {
  TtyAddress address;
  std::string_view rate = parameters;
  if (!parameters.starts_with(kBaudKey)) {
    const std::size_t comma = parameters.find(',');
    address.path = parameters.substr(0, comma);
    if (comma == parameters.npos) return address;
    rate = parameters.substr(comma + 1);
  }
  if (!rate.starts_with(kBaudKey))
    return schema::fail(
        ErrorKind::usage, fmt::format("'{}' is not an address of a serial port", parameters), "device",
        "give tty: (if there is only one), tty:/dev/ttyACM0 or tty:/dev/ttyACM0,baud=2000000");
  const auto baud = parse_baud(rate.substr(kBaudKey.size()));
  TACTO_TRY(baud);
  address.baud = *baud;
  return address;
}

std::string tty_uri(const TtyAddress& address) {
  if (!address.baud) return "tty:" + address.path;
  return fmt::format("tty:{}{}{}{}", address.path, address.path.empty() ? "" : ",", kBaudKey, *address.baud);
}

}  // namespace tacto::firmware_host
