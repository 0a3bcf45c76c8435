// SPDX-License-Identifier: GPL-3.0-or-later
// One choice as it was measured: what it errs, what it costs.
#pragma once

#include <cmath>
#include <limits>
#include <string>

namespace tacto::analysis {

struct TradeRow {
  std::string knob, choice;
  double error = 0;    ///< RMS of what is off against the exact reference, re the reference's RMS
  double cost_ns = 0;  ///< 0: nobody measured it
  std::string per;     ///< what the cost is of: "frame", "sample", "tick", "cell", "ms" of playing
  double memory_bytes = 0;
  double latency_s = 0;
  std::string note;

  /// Only what was measured is held against others.
  bool is_judged() const { return !std::isnan(error); }
};

/// The error of a choice of which nobody measured one.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

}  // namespace tacto::analysis
