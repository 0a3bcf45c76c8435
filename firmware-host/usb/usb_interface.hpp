// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the interface of the wire among a USB device's interfaces.
#pragma once

#include <cstdint>
#include <optional>

struct libusb_config_descriptor;

namespace tacto::firmware_host {

struct UsbInterface {
  std::uint8_t number = 0, setting = 0;
  std::uint8_t in = 0, out = 0;  ///< addresses of the bulk endpoints
};

/// The first interface with the wire's class and subclass (core/firmware/usb_identity.hpp) and one bulk
/// endpoint in each direction. With any protocol number, so that a device of another version can be refused
/// by name.
std::optional<UsbInterface> wire_interface(const libusb_config_descriptor& configuration);

}  // namespace tacto::firmware_host
