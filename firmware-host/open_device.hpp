// SPDX-License-Identifier: GPL-3.0-or-later
// Opens the device for a URI: on USB, on a serial port, emulated, or a recording played as a device.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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

/// As open_device(), but a data acquisition card is opened to play, instead of being sampled by its own clock
/// (open_comedi_to_play()). Errors: besides, usage: `without_watchdog` for another device.
schema::Result<std::unique_ptr<Device>> open_device_to_play(const std::string& uri,
                                                            bool without_watchdog = false);

struct DeviceToRecord {
  std::unique_ptr<Device> device;
  bool ends_by_itself = false;  ///< a replay: its stream ends with the recording
  /// The largest number of strokes; nullopt if a person decides it, or if there is no limit.
  std::optional<std::uint64_t> strokes;
};

/// As open_device(), but an emulated finger makes strokes without limit if the URI does not give their
/// number. The frames of the first strokes are the same, bit by bit. Errors: as open_device().
schema::Result<DeviceToRecord> open_device_to_record(const std::string& uri);

}  // namespace tacto::firmware_host
