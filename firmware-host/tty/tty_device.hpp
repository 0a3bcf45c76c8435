// SPDX-License-Identifier: GPL-3.0-or-later
// A device on a serial port as a Device.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/link/device.hpp"
#include "firmware-host/tty/tty_address.hpp"

namespace tacto::firmware_host {

/// "/dev/ttyACM0", ... in alphabetical order: each tty whose hardware is a USB device, by the kernel's list
/// below `root`/sys/class/tty. Other serial ports, terminals and consoles are left out.
std::vector<std::string> usb_serial_ports(const std::string& root = "/");

/// `parameters` is the text after "tty:". Without a path it is the only device among those on USB serial
/// ports. Errors: as parse_tty_address(), TtyTransport::open(), WireDevice::open() and open_tty_among().
schema::Result<std::unique_ptr<Device>> open_tty_device(const std::string& uri, std::string_view parameters);

/// The only one of the ports on which a device answers; each is greeted. Errors: not_found: no port, or no
/// device on any, with the reason of each; usage: several devices, with their URIs; of a single port its own.
schema::Result<std::unique_ptr<Device>> open_tty_among(std::span<const TtyAddress> ports);

/// The URI of each USB serial port, whatever is connected to it.
std::vector<std::string> tty_uris();

}  // namespace tacto::firmware_host
