// SPDX-License-Identifier: GPL-3.0-or-later
// Evenly sampled signals, with the axis in the type: a signal over time cannot be used as one over space.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::schema {

/// A value over time: sample i was taken at start_s + i / sample_rate_hz. Values in the SI unit of their
/// quantity.
struct TimeSignal {
  double sample_rate_hz = 0;
  double start_s = 0;
  std::vector<double> values;

  double time_s(std::size_t i) const { return start_s + static_cast<double>(i) / sample_rate_hz; }
  double duration_s() const { return static_cast<double>(values.size()) / sample_rate_hz; }
};

/// A value over position: sample i belongs to origin_m + i * pitch_m. Values in the SI unit of their
/// quantity.
struct SpaceSignal {
  double pitch_m = 0;
  double origin_m = 0;
  std::vector<double> values;

  double position_m(std::size_t i) const { return origin_m + static_cast<double>(i) * pitch_m; }
  double length_m() const { return values.empty() ? 0 : static_cast<double>(values.size() - 1) * pitch_m; }
};

}  // namespace tacto::schema
