// SPDX-License-Identifier: GPL-3.0-or-later
// From what the user names to a device that is open: on USB, emulated, or a recording played as one.
#pragma once

#include <memory>
#include <string>

#include "data-schema/base/error.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// Opens by URI; there are `usb:`, the only device on USB, or one by `serial=` or `port=`; `sim:`, with every
/// parameter by key=value (see sim/sim_parameters.hpp); and `replay:FILE`, a recording as a device.
/// Errors: usage: a transport, key or value that does not exist, naming what there is, or several devices on
/// USB; not_found: no such device, or not permitted; the transducer's file; as WireDevice::open().
schema::Result<std::unique_ptr<Device>> open_device(const std::string& uri);

}  // namespace tacto::firmware_host
