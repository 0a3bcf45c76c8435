// SPDX-License-Identifier: GPL-3.0-or-later
// Where the emulated device's frames come from.
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

  /// One sample period on, and the frame at its end: a code of each channel. False where it can't go on.
  virtual bool next(std::span<std::int32_t> frame) = 0;
  /// The encoder's, at the end of that period.
  virtual std::int32_t encoder_count() const = 0;
};

}  // namespace tacto::firmware_host
