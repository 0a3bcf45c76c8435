// SPDX-License-Identifier: GPL-3.0-or-later
// A device opened for its stream alone: an emulated finger strokes for as long as it is recorded.
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
  /// How many strokes there will be at most; nullopt where a person decides, or they go on without end.
  std::optional<std::uint64_t> strokes;
};

/// As open_device(); but an emulated finger that the URI gives no number of strokes makes them without end.
/// The frames of the first strokes are the same, to the bit. Errors: as open_device().
schema::Result<DeviceToRecord> open_device_to_record(const std::string& uri);

}  // namespace tacto::firmware_host
