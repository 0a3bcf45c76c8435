// SPDX-License-Identifier: GPL-3.0-or-later
// The address of a device on USB.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// The text after "usb:". Both empty: the only device.
struct UsbAddress {
  std::string serial;
  std::string port;  ///< bus and the ports up to the device, in the kernel's notation: "1-2.4"
};

/// "", "serial=XYZ" or "port=1-2.4"; a serial may contain any byte except a comma. Errors: usage.
schema::Result<UsbAddress> parse_usb_address(std::string_view parameters);

/// The properties of a device that are known before it is opened.
struct UsbName {
  std::string serial;  ///< empty if it has none, or if this user may not read it
  std::string port;
};

/// The URI that identifies `names[index]`: by serial, or by port if the serial is missing or not unique.
std::string usb_uri(const std::vector<UsbName>& names, std::size_t index);

/// The index of the device in `names`. Errors: not_found: it does not exist; usage: several match, with their
/// names.
schema::Result<std::size_t> choose_usb(const std::vector<UsbName>& names, const UsbAddress& address);

}  // namespace tacto::firmware_host
