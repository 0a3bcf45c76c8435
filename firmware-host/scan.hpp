// SPDX-License-Identifier: GPL-3.0-or-later
// What devices are there.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/device.hpp"

namespace tacto::firmware_host {

/// A device that can be named, and what it said when it was greeted, or why it did not.
struct FoundDevice {
  std::string uri;
  schema::Result<Capabilities> said;
};

/// Emulated ones too: one for each surface. A replay has to be named and is not listed.
std::vector<FoundDevice> scan_devices();

}  // namespace tacto::firmware_host
