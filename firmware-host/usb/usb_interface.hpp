// SPDX-License-Identifier: GPL-3.0-or-later
// The wire's interface among a USB device's interfaces.
#pragma once

#include <cstdint>
#include <optional>

struct libusb_config_descriptor;

namespace tacto::firmware_host {

struct UsbInterface {
  std::uint8_t number = 0, setting = 0;
  std::uint8_t in = 0, out = 0;  ///< bulk endpoints' addresses
};

/// The first interface of the wire's class and subclass (core/usb_identity.hpp) with one bulk endpoint each
/// way. Any protocol: a device of another version is greeted, so that it can be refused by name.
std::optional<UsbInterface> wire_interface(const libusb_config_descriptor& configuration);

}  // namespace tacto::firmware_host
