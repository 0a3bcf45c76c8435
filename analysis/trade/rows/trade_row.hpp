// SPDX-License-Identifier: GPL-3.0-or-later
// One choice as it was measured: what it errs, what it costs.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tacto::analysis {

/// What a choice errs under a finger of one speed; NaN where that finger has nothing to feel in the band.
struct ErrorAtSpeed {
  double speed_mps = 0, error = 0;
};

struct TradeRow {
  std::string knob, choice;
  double error = 0;    ///< RMS of what is off against the exact reference, re the reference's RMS
  double cost_ns = 0;  ///< 0: nobody measured it
  std::string per;     ///< what the cost is of: "frame", "sample", "tick", "cell", "ms" of playing
  double memory_bytes = 0;
  double latency_s = 0;
  std::string note;
  std::vector<ErrorAtSpeed> by_speed = {};  ///< of which `error` is the worst; none where no finger goes

  /// Only what was measured is held against others.
  bool is_judged() const { return !std::isnan(error); }

  /// Under which finger it errs most; NaN where none goes.
  double worst_speed_mps() const {
    const auto worst = std::ranges::find(by_speed, error, &ErrorAtSpeed::error);
    return worst == by_speed.end() ? std::numeric_limits<double>::quiet_NaN() : worst->speed_mps;
  }
};

/// The error of a choice of which nobody measured one.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

}  // namespace tacto::analysis
