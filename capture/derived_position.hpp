// SPDX-License-Identifier: GPL-3.0-or-later
// A position where none was measured: from a speed that was, or one that was only meant.
#pragma once

#include <span>
#include <vector>

#include "data-schema/recording.hpp"

namespace tacto::capture {

/// A channel that was made, and its numbers, in metres.
struct DerivedChannel {
  schema::Channel channel;
  std::vector<double> values;
};

/// speed * time, from 0 at the first frame; `derivation` says "nominal: 40 mm/s". Times of the header's
/// frames, gaps counted; header.frames must be set.
DerivedChannel nominal_position(const schema::RecordingHeader& header, double speed_mps);

/// The trapezoid rule over a speed channel, from 0 at the first frame. Across a gap it takes the speed to
/// have changed evenly. `stored` is the channel's.
DerivedChannel integrated_position(const schema::RecordingHeader& header, const schema::Channel& speed,
                                   std::span<const double> stored);

}  // namespace tacto::capture
