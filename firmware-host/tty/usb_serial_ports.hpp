// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the serial ports that are on USB.
#pragma once

#include <string>
#include <vector>

namespace tacto::firmware_host {

/// "/dev/ttyACM0", ... in alphabetical order: each tty whose hardware is a USB device, by the kernel's list
/// below `root`/sys/class/tty. Other serial ports, terminals and consoles are left out.
std::vector<std::string> usb_serial_ports(const std::string& root = "/");

}  // namespace tacto::firmware_host
