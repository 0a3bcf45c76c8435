// SPDX-License-Identifier: Apache-2.0
// The data of one tick that the device streams.
#pragma once

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::core {

inline constexpr uint32_t kRingRecords = 256;  ///< 12.8 ms at 20 kHz
inline constexpr uint32_t kDriveQueue = 1024;  ///< samples

struct Record {
  uint64_t clock = 0, frame = 0, tick = 0;
  int32_t encoder = 0;
  float drive_v = 0;
  uint32_t flags = 0;  ///< wire::TickFlag
  uint8_t run = 0;     ///< the number of the stream's start
  bool sampled = false, driven = false;
  uint8_t axes = 0;  ///< of a scene; 0: the tick has a drive
  int32_t codes[wire::kMaxChannels] = {};
  int32_t counts[wire::kMaxAxes] = {};
  float force_n[wire::kMaxAxes] = {};
};

}  // namespace tacto::core
