// SPDX-License-Identifier: GPL-3.0-or-later
// Opens the device for a URI: on USB, on a serial port, emulated, or a recording played as a device.
#pragma once

#include <memory>
#include <string>

#include "data-schema/base/error.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// Opens by URI: `usb:`, the only device on USB, or one by `serial=` or `port=`; `tty:`, the only one on the
/// USB serial ports, or `tty:PATH`, with `baud=`; `sim:`, with parameters as key=value (see
/// sim/device/sim_parameters.hpp); `replay:FILE`, a recording as a device. Errors: usage: a transport, key or
/// value that does not exist, with the possible ones, or several devices on USB or its serial ports;
/// not_found: no such device, or not permitted; the transducer's file; as WireDevice::open().
schema::Result<std::unique_ptr<Device>> open_device(const std::string& uri);

}  // namespace tacto::firmware_host
