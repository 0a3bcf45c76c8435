// SPDX-License-Identifier: GPL-3.0-or-later
// Lists the available devices.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// A device that can be opened by name, with its description or the reason why it has none.
struct FoundDevice {
  std::string uri;
  schema::Result<Capabilities> said;
};

/// Those on USB first; if the bus cannot be read, the entry "usb:" has the reason. Then each USB serial port,
/// with the reason if no device answers there. Then the emulated ones, one per surface. A replay needs a file
/// and is not listed. Each device is greeted, which ends a stream that no program reads.
std::vector<FoundDevice> scan_devices();

}  // namespace tacto::firmware_host
