// SPDX-License-Identifier: GPL-3.0-or-later
// The drift of a stream's clock against the recorder's, from clock offsets of which some may be wrong.
#pragma once

#include <optional>
#include <span>

#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

struct OffsetDrift {
  double drift_ppm = 0;                    ///< above zero: the stream's clock is fast
  double lowest_ppm = 0, highest_ppm = 0;  ///< the 95 % interval of the drift
  double deviation_s = 0;                  ///< the median of the distances from the line
  bool is_certain() const { return lowest_ppm > 0 || highest_ppm < 0; }
};

/// Theil-Sen: the median of the slopes through all pairs of offsets, so that up to 29 % of them may be wrong
/// by any amount; its interval is Sen's (J. Am. Stat. Assoc. 63, 1968, 1379-1389). More than 1,000 offsets
/// are reduced to medians of consecutive ones. None for fewer than 4 offsets, whose interval has no end, or
/// if they span less than 10 s. The interval assumes independent deviations. `pairs`: in the order of time.
std::optional<OffsetDrift> offset_drift(std::span<const schema::ClockPair> pairs);

}  // namespace tacto::capture
