// SPDX-License-Identifier: GPL-3.0-or-later
// What devices are there.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// A device that can be named, and what it said when it was greeted, or why it did not.
struct FoundDevice {
  std::string uri;
  schema::Result<Capabilities> said;
};

/// Those on USB first; where the bus can't be looked at, "usb:" says why. Emulated ones too: one for each
/// surface. A replay has to be named and is not listed. Each is greeted, which ends a stream that its device
/// sends to nobody.
std::vector<FoundDevice> scan_devices();

}  // namespace tacto::firmware_host
