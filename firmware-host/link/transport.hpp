// SPDX-License-Identifier: GPL-3.0-or-later
// A stream of bytes to a device and back: USB, or an emulated device in this process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// Carries bytes, knows nothing of frames. One thread.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Gives at least one byte, or 0 where none came within `timeout_s`. Errors: device: it is gone.
  virtual schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) = 0;
  /// All bytes, or an error. Errors: device: it is gone, or took them not within `timeout_s`.
  virtual schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) = 0;
  /// The clock that timeouts are counted in; an emulated device's is its own.
  virtual double now_s() = 0;
};

}  // namespace tacto::firmware_host
