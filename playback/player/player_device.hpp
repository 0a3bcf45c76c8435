// SPDX-License-Identifier: GPL-3.0-or-later
// Opens the device for a playback and locks it for this process.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "firmware-host/link/client.hpp"
#include "firmware-host/link/device.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/player/flight_recorder.hpp"

namespace tacto::playback {

/// A lock against the other programs of this project; it ends with the process, even if that is killed.
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

/// The movement of an emulated device's finger.
struct FingerScript {
  FingerPath path;
  /// Repeat the path: from its beginning if its end meets that (within 1 um), else back and forth. Otherwise
  /// the finger rests at the end.
  bool repeated = false;
  bool waits = false;  ///< wait at the beginning until PlayerDevice::begin_path()
};

/// The script of a finger path's CSV, repeated without end; none if no file is named. Errors: as
/// read_finger_path.
schema::Result<std::optional<FingerScript>> read_finger_script(const std::string& file);

struct PlayerDevice {
  std::unique_ptr<firmware_host::Device> device;
  firmware_host::Client* client = nullptr;
  std::string uri;
  DeviceLock lock;
  std::function<void()> begin_path;  ///< starts a script that waits; from any thread

  /// For PlayerOptions. Emulated time can wait for the recorder, so no tick needs to be lost.
  FullQueue full_queue() const { return device->is_real_time() ? FullQueue::lose : FullQueue::wait; }
};

/// Opens by URI (see open_device_to_play), and locks a device that other programs could open too. A script is
/// for `sim:` only. Errors: as open_device_to_play; unsuitable: a device without playback (a replay), a
/// script for a real one; another program plays on it.
schema::Result<PlayerDevice> open_player_device(const std::string& uri,
                                                const std::optional<FingerScript>& script,
                                                bool without_watchdog = false);

/// A force device, as its file describes it, or as it describes itself.
struct ForceDevice {
  PlayerDevice player;
  schema::Device about;
  std::optional<schema::Hand> hand = std::nullopt;  ///< that holds an emulated device
  std::optional<double> path_s = std::nullopt;      ///< duration of the path
};

/// `path`, of an emulated device: the place to which the person moves the hand, or the path of the device
/// without a hand (read_axis_paths()), once or repeated as that of a finger; empty: all axes at 0. Errors: as
/// open_player_device, read_axis_paths, check_travel; unsuitable: no axes with forces; a path for a device
/// that is not emulated.
schema::Result<ForceDevice> open_force_device(const std::string& uri, const std::string& path,
                                              bool repeated = false);

}  // namespace tacto::playback
