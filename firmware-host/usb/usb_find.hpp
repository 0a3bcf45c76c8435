// SPDX-License-Identifier: GPL-3.0-or-later
// The devices of ours that are on USB.
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

/// Everything on USB with an interface of the wire, whatever its vendor, in the order of buses and ports.
/// Asks each for its serial where this user may. Errors: device: the bus can't be looked at.
schema::Result<std::vector<UsbFound>> find_usb(libusb_context* context);

std::vector<UsbName> names_of(const std::vector<UsbFound>& found);

}  // namespace tacto::firmware_host
