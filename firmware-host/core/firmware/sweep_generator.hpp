// SPDX-License-Identifier: Apache-2.0
// The sine of the identification sweep.
#pragma once

#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// sin(2 pi phase / 2^32), by the Taylor polynomial of degree 9 after reduction to a quarter turn: the error
/// is at most 4e-6. Safe in the tick.
float sine_of_phase(uint32_t phase) noexcept;

/// Phase and frequency are integers (2^-64 turns per tick), so that the sweep has the same bits on every
/// machine. Safe in the tick except set().
class SweepGenerator {
 public:
  /// Returns false if a frequency is zero or at least half the rate, or if the second is below the first. The
  /// rate is in mHz.
  bool set(const wire::Sweep& sweep, uint32_t rate_millihertz) noexcept;
  /// The next value in volts; zero after the last frequency.
  float next() noexcept;
  bool done() const noexcept { return step_ >= last_step_; }

 private:
  float amplitude_v_ = 0;
  uint64_t phase_ = 0, step_ = 0, last_step_ = 0;  // turns x 2^64
  uint32_t growth_q32_ = 0;
};

}  // namespace tacto::core
