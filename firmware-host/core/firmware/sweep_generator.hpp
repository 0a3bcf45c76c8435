// SPDX-License-Identifier: Apache-2.0
// The sine of the identification sweep.
#pragma once

#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// sin(2 pi phase / 2^32), by Taylor's polynomial of degree 9 on the folded quarter turn: the error is at
/// most 4e-6. Safe in the tick.
float sine_of_phase(uint32_t phase) noexcept;

/// Phase and frequency are integers (2^-64 of a turn a tick), so that the sweep is the same to the bit
/// everywhere. Safe in the tick but for set().
class SweepGenerator {
 public:
  /// False where a frequency is zero, reaches half the rate, or the second is below the first. The rate in
  /// mHz.
  bool set(const wire::Sweep& sweep, uint32_t rate_millihertz) noexcept;
  /// The next value in volts; zero once the last frequency is reached.
  float next() noexcept;
  bool done() const noexcept { return step_ >= last_step_; }

 private:
  float amplitude_v_ = 0;
  uint64_t phase_ = 0, step_ = 0, last_step_ = 0;  // turns x 2^64
  uint32_t growth_q32_ = 0;
};

}  // namespace tacto::core
