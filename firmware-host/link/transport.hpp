// SPDX-License-Identifier: GPL-3.0-or-later
// A byte stream to a device and back: USB, a serial line, or an emulated device in this process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// Carries bytes and does not depend on frames. For one thread.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Returns at least one byte, or 0 if none arrives within `timeout_s`. Errors: device: it is gone.
  virtual schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) = 0;
  /// Writes all bytes or returns an error. Errors: device: it is gone, or did not accept them within
  /// `timeout_s`.
  virtual schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) = 0;
  /// The clock of the timeouts; an emulated device has its own.
  virtual double now_s() = 0;
  /// Of a serial line, with 10 bits for each byte. A link without such a limit is infinitely fast.
  virtual double baud() const { return std::numeric_limits<double>::infinity(); }
  /// The time that a device may need before it answers, because opening the link has restarted it.
  virtual double start_up_s() const { return 0; }
};

}  // namespace tacto::firmware_host
