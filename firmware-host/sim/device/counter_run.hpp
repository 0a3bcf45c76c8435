// SPDX-License-Identifier: GPL-3.0-or-later
// Frames with consecutive numbers as codes, so that each lost or repeated frame is detected.
#pragma once

#include "firmware-host/core/wire/message_types.hpp"
#include "firmware-host/sim/device/frame_source.hpp"

namespace tacto::firmware_host {

/// The code of channel c in frame i is 16 i + c, modulo 2^32: it wraps after 2^28 frames, 45 min at 100 kHz.
/// No physics, and almost no computation.
class CounterRun final : public FrameSource {
 public:
  bool next(std::span<std::int32_t> frame) override {
    std::uint32_t code = frames_++ * std::uint32_t{wire::kMaxChannels};
    for (std::int32_t& sample : frame) sample = static_cast<std::int32_t>(code++);
    return true;
  }
  std::int32_t encoder_count() const override { return 0; }

 private:
  std::uint32_t frames_ = 0;
};

}  // namespace tacto::firmware_host
