// SPDX-License-Identifier: Apache-2.0
// Collects records into messages without gaps.
#pragma once

#include "firmware-host/core/firmware/record.hpp"
#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::core {

/// Frames of one samples message. For the main loop.
class SampleBlock {
 public:
  void begin(uint8_t channels, uint8_t frames) noexcept;
  bool fits(const Record& record) const noexcept;
  void add(const Record& record) noexcept;
  bool full() const noexcept { return block_.count >= frames_; }
  bool empty() const noexcept { return block_.count == 0; }
  void clear() noexcept { block_.count = 0; }
  const wire::Samples& message() const noexcept { return block_; }

 private:
  wire::Samples block_;
  uint8_t frames_ = 1;
};

/// Ticks of one ticks message. For the main loop.
class TickBlock {
 public:
  void begin(uint8_t ticks) noexcept { limit_ = ticks, block_.count = 0; }
  bool fits(const Record& record) const noexcept;
  void add(const Record& record) noexcept;
  bool full() const noexcept { return block_.count >= limit_; }
  bool empty() const noexcept { return block_.count == 0; }
  void clear() noexcept { block_.count = 0; }
  const wire::Ticks& message() const noexcept { return block_; }

 private:
  wire::Ticks block_;
  uint8_t limit_ = 1;
};

/// Ticks of one axis_ticks message. For the main loop.
class AxisTickBlock {
 public:
  void begin(uint8_t ticks, uint8_t axes) noexcept { limit_ = ticks, block_.axes = axes, block_.count = 0; }
  bool fits(const Record& record) const noexcept;
  void add(const Record& record) noexcept;
  bool full() const noexcept { return block_.count >= limit_; }
  bool empty() const noexcept { return block_.count == 0; }
  void clear() noexcept { block_.count = 0; }
  const wire::AxisTicks& message() const noexcept { return block_; }

 private:
  wire::AxisTicks block_;
  uint8_t limit_ = 1;
};

}  // namespace tacto::core
