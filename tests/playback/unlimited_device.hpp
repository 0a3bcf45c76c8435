// SPDX-License-Identifier: GPL-3.0-or-later
// A force device whose limits no test reaches.
#pragma once

#include <string>

#include "data-schema/device/device.hpp"

namespace tacto::playback {

/// The preset with other encoder steps.
inline schema::Device unlimited_device(double encoder_step_m, const std::string& preset = "sandpaper-1990") {
  schema::Device device = *schema::read_device(preset);
  for (schema::DeviceAxis& axis : device.axes) {
    axis.peak_force_n = axis.continuous_force_n = 1e9;
    axis.encoder_step_m = encoder_step_m;
  }
  device.peak_force_n = device.continuous_force_n = 1e9;
  device.slew_n_per_s = 1e15;
  return device;
}

}  // namespace tacto::playback
