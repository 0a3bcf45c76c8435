// SPDX-License-Identifier: GPL-3.0-or-later
// The device that is played on, opened and held for this process alone.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "firmware-host/link/client.hpp"
#include "firmware-host/link/device.hpp"
#include "playback/model/finger_path.hpp"

namespace tacto::playback {

/// A lock that other programs of ours respect, and that goes with this process however it ends.
class DeviceLock {
 public:
  /// Errors: unsuitable: another program plays on the device.
  static schema::Result<DeviceLock> take(const std::string& device_name);
  DeviceLock() = default;
  DeviceLock(DeviceLock&& other) noexcept;
  DeviceLock& operator=(DeviceLock&& other) noexcept;
  ~DeviceLock();

 private:
  explicit DeviceLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

/// What an emulated device's finger does.
struct FingerScript {
  FingerPath path;
  /// Over and over: from its beginning where its end meets that (within 1 um), else there and back. Not
  /// repeated it rests at the end.
  bool repeated = false;
  bool waits = false;  ///< at its beginning, until PlayerDevice::begin_path()
};

/// The script of a finger path's CSV; none where no file is named. Errors: as read_finger_path.
schema::Result<std::optional<FingerScript>> read_finger_script(const std::string& file, bool repeated);

struct PlayerDevice {
  std::unique_ptr<firmware_host::Device> device;
  firmware_host::Client* client = nullptr;
  std::string uri;
  DeviceLock lock;
  std::function<void()> begin_path;  ///< of a script that waits; from any thread
};

/// Opens by URI (see open_device), and locks what other programs could open too. A script is for `sim:`
/// alone. Errors: as open_device; unsuitable: a device that nothing can be played on (a replay), a script for
/// a real one; another program plays on it.
schema::Result<PlayerDevice> open_player_device(const std::string& uri,
                                                const std::optional<FingerScript>& script);

}  // namespace tacto::playback
