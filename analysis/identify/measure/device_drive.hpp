// SPDX-License-Identifier: GPL-3.0-or-later
// Plays a drive into a device, and brings back what the device drove and where its tray was.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::analysis {

/// Sample by sample at one rate: drive_v[i] is held from the instant of displacement_m[i] to the next.
struct DrivenTray {
  double rate_hz = 0;
  std::vector<double> drive_v, displacement_m;
  std::size_t limited = 0;  ///< ticks that were held to a limit of the device
};

/// Streams, arms with the host as the drive's source, keeps the device's queue filled, and pairs its ticks
/// with its frames by the device's own clock. The drive is what the ticks say was put out, limits included.
/// Errors: unsuitable: nothing can be played on it, or it has no channel of the quantity `displacement`;
/// device: it refused, frames or ticks were lost, or the drive did not come in time; usage: stopped.
schema::Result<DrivenTray> drive_tray(firmware_host::Device& device, std::span<const float> drive_v,
                                      const std::function<bool()>& stop_asked,
                                      const std::function<void(double)>& progress);

/// The rate that drive_tray() plays at: the device's own.
double drive_rate_hz(const firmware_host::Device& device);

}  // namespace tacto::analysis
