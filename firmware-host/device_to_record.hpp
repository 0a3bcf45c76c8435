// SPDX-License-Identifier: GPL-3.0-or-later
// Opens a device for recording: an emulated finger makes strokes until the recording ends.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "data-schema/base/error.hpp"
#include "firmware-host/link/device.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::firmware_host {

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
