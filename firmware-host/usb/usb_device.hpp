// SPDX-License-Identifier: GPL-3.0-or-later
// A device on USB as a Device.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// `parameters` is the text after "usb:". Its capabilities contain the URI that distinguishes it from other
/// devices. Errors: as parse_usb_address(), UsbConnection::open(), WireDevice::open().
schema::Result<std::unique_ptr<Device>> open_usb_device(const std::string& uri, std::string_view parameters);

/// The URI of each of our devices on USB, even if it cannot be opened. Errors: device: the bus cannot be
/// read.
schema::Result<std::vector<std::string>> usb_uris();

}  // namespace tacto::firmware_host
