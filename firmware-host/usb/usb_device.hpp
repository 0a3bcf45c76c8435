// SPDX-License-Identifier: GPL-3.0-or-later
// A device on USB as a Device.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// `parameters` is what follows "usb:". Its capabilities name it by the URI that tells it from the others.
/// Errors: as parse_usb_address(), UsbConnection::open(), WireDevice::open().
schema::Result<std::unique_ptr<Device>> open_usb_device(const std::string& uri, std::string_view parameters);

/// The URI of each device of ours on USB, whether it can be opened or not. Errors: device: the bus can't be
/// looked at.
schema::Result<std::vector<std::string>> usb_uris();

}  // namespace tacto::firmware_host
