// SPDX-License-Identifier: GPL-3.0-or-later
// What a recording's sidecar stores of a stroke.
#pragma once

#include <cstdint>
#include <optional>

namespace tacto::schema {

/// A stroke (stroke_rule.hpp), found when the recording was complete. Frames are stored ones.
struct StrokeFigures {
  std::uint64_t first_frame = 0, frames = 0;
  double length_m = 0;
  int direction = 1;  ///< -1: backwards
  double mean_speed_mps = 0;
  std::optional<double> mean_normal_n;  ///< none where no normal force is recorded
  std::uint64_t clipped_samples = 0;    ///< over all channels
  std::uint64_t lost_frames = 0;        ///< missing directly before or after it
};

/// The range that the finger should keep (Wiertlewski 2011, section IV-A5: 50 mm/s, 0.5 N).
struct TargetBand {
  double middle = 0, width = 0;  ///< middle +- width

  bool holds(double value) const { return value >= middle - width && value <= middle + width; }
};
inline constexpr TargetBand kTargetSpeed_mps = {50e-3, 15e-3};
inline constexpr TargetBand kTargetLoad_n = {0.5, 0.25};

}  // namespace tacto::schema
