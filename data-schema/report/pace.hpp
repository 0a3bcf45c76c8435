// SPDX-License-Identifier: GPL-3.0-or-later
// How much faster than real time an emulated device ran.
#pragma once

#include <fmt/format.h>

#include <chrono>

#include "data-schema/report/report.hpp"

namespace tacto::cli {

/// Measures from its construction on.
class Pace {
 public:
  /// Adds `times_real_time`: seconds of the device per second that has passed, and `pace`, the same in words.
  void add_to(Report& report, double device_s) const {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begun_;
    const double times = device_s / passed.count();
    report.add("times_real_time", times)
        .add("pace", fmt::format("{:.3g} times real time, as fast as this computer allows; with paced=1 it "
                                 "runs in real time",
                                 times));
  }

 private:
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace tacto::cli
