// SPDX-License-Identifier: Apache-2.0
// The description of a board, and the memory that it provides.
#pragma once

#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::core {

/// All of it has to outlive the firmware. In `about`, the board sets name, serial, firmware, features,
/// clock_hz, the three rates and the two limits; the core sets the rest.
struct Board {
  wire::Welcome about;
  const wire::Channel* channels = nullptr;
  uint8_t channel_count = 0;  ///< at most wire::kMaxChannels
  const wire::Note* notes = nullptr;
  uint8_t note_count = 0;
  float* profile_memory = nullptr;  ///< also holds the scene
  uint32_t profile_samples = 0;
  /// Of a device with forces; otherwise null. The core sets scene_bytes.
  const wire::Axes* axes = nullptr;
};

}  // namespace tacto::core
