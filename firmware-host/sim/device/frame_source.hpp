// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of the emulated device's sources of frames.
#pragma once

#include <cstdint>
#include <span>

namespace tacto::firmware_host {

class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Computes one sample period, and the frame at its end: one code per channel. False if it cannot continue.
  virtual bool next(std::span<std::int32_t> frame) = 0;
  /// The count of the encoder at the end of that period.
  virtual std::int32_t encoder_count() const = 0;
};

}  // namespace tacto::firmware_host
