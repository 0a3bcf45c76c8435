// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a drive on a device and returns the actual drive and the displacement of the tray.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::analysis {

/// One value per sample. drive_v[i] is held from the time of displacement_m[i] to the next sample.
struct DrivenTray {
  double rate_hz = 0;
  std::vector<double> drive_v, displacement_m;
  std::size_t limited = 0;  ///< number of ticks in which a limit of the device was active
};

/// Starts the stream, arms with the host as the drive's source, keeps the device's queue filled, and pairs
/// its ticks with its frames by the device's clock. The drive is the output that the ticks report, with
/// limits. Errors: unsuitable: the device cannot play, or has no channel of the quantity `displacement`;
/// device: it refused, frames or ticks were lost, or the drive arrived late; usage: stopped.
schema::Result<DrivenTray> drive_tray(firmware_host::Device& device, std::span<const float> drive_v,
                                      const std::function<bool()>& stop_asked,
                                      const std::function<void(double)>& progress);

/// The rate of drive_tray(): the device's own rate.
double drive_rate_hz(const firmware_host::Device& device);

}  // namespace tacto::analysis
