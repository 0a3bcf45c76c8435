// SPDX-License-Identifier: GPL-3.0-or-later
// Which device on USB is meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// What follows "usb:". Both empty: the only one there is.
struct UsbAddress {
  std::string serial;
  std::string port;  ///< bus, and the ports on the way to it, as the kernel names them: "1-2.4"
};

/// "", "serial=XYZ" or "port=1-2.4"; a serial may hold any byte but the comma. Errors: usage.
schema::Result<UsbAddress> parse_usb_address(std::string_view parameters);

/// A device as far as it is known before it is opened.
struct UsbName {
  std::string serial;  ///< empty where it has none, or this user may not ask it
  std::string port;
};

/// The URI that tells `names[index]` from the others: by serial, or by port where that is no serial of one.
std::string usb_uri(const std::vector<UsbName>& names, std::size_t index);

/// Which of `names` is meant. Errors: not_found: it is not there; usage: several are, naming them.
schema::Result<std::size_t> choose_usb(const std::vector<UsbName>& names, const UsbAddress& address);

}  // namespace tacto::firmware_host
