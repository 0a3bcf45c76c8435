// SPDX-License-Identifier: GPL-3.0-or-later
// The tick kernel in double precision: the reference for the error of single precision.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::firmware_host {

/// The input of a kernel.
struct TickSetup {
  wire::ProfileBegin scale;
  std::vector<float> profile;  ///< scale.samples of them
  std::vector<wire::Section> sections;
  wire::Limits limits;
  double gain = 1;
  double rate_hz = 10e3;
};

/// drive = limits(envelope x sections(gain x profile(count))), as core::TickKernel states it, written from
/// those formulas and not from its source: positions as doubles (to 2^-20 of a sample for 2^32 counts), fmod
/// for the ends, the sections in direct form I. Slow; not for the tick.
class ExactTick {
 public:
  explicit ExactTick(TickSetup setup);

  double profile_at(std::int64_t count) const;
  double tick(std::int64_t count, bool raise);

 private:
  struct Past {
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
  };
  double sample(double index) const;

  TickSetup setup_;
  std::vector<Past> pasts_;
  double level_ = 0, last_v_ = 0;
};

}  // namespace tacto::firmware_host
