// SPDX-License-Identifier: GPL-3.0-or-later
// The measured error and cost of one choice.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tacto::analysis {

/// The error of a choice under a finger of one speed; NaN if that finger has too little of the texture in the
/// band.
struct ErrorAtSpeed {
  double speed_mps = 0, error = 0;
};

struct TradeRow {
  std::string knob, choice;
  double error = 0;    ///< RMS of the difference from the exact reference, re the reference's RMS
  double cost_ns = 0;  ///< 0: not measured
  std::string per;     ///< unit of the cost: "frame", "sample", "tick", "cell", "ms" of playing
  double memory_bytes = 0;
  double latency_s = 0;
  std::string note;
  std::vector<ErrorAtSpeed> by_speed = {};  ///< `error` is the worst of them; empty without a finger

  /// Only measured errors are compared with others.
  bool is_judged() const { return !std::isnan(error); }

  /// The speed with the largest error; NaN without a finger.
  double worst_speed_mps() const {
    const auto worst = std::ranges::find(by_speed, error, &ErrorAtSpeed::error);
    return worst == by_speed.end() ? std::numeric_limits<double>::quiet_NaN() : worst->speed_mps;
  }
};

/// The error of a choice that was not measured.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

}  // namespace tacto::analysis
