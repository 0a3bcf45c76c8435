// SPDX-License-Identifier: GPL-3.0-or-later
// Finds our devices on USB.
#pragma once

#include <vector>

#include "firmware-host/usb/usb_address.hpp"
#include "firmware-host/usb/usb_interface.hpp"
#include "firmware-host/usb/usb_pointer.hpp"

namespace tacto::firmware_host {

struct UsbFound {
  UsbName name;
  UsbInterface interface;
  UsbPointer<libusb_device> device;
};

/// Every USB device with an interface of the wire, of any vendor, in the order of buses and ports, with its
/// serial if this user may read it. Errors: device: the bus cannot be read.
schema::Result<std::vector<UsbFound>> find_usb(libusb_context* context);

std::vector<UsbName> names_of(const std::vector<UsbFound>& found);

}  // namespace tacto::firmware_host
