// SPDX-License-Identifier: GPL-3.0-or-later
// The finger's position, frame by frame, in a record of any length; overflows of counters are corrected.
#pragma once

#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/strokes/counter_wraps.hpp"
#include "spatial/strokes/frame_range.hpp"
#include "spatial/strokes/touch_source.hpp"

namespace tacto::spatial {

/// Reads stretches of the position. A short record (1e6 frames, 8 MB) is held in memory; of a longer one only
/// what was requested. The source must outlive it.
class PositionTrack {
 public:
  /// Reads the whole record once, to find the wraps of its counter. Errors: of reading.
  static schema::Result<PositionTrack> open(TouchSource& source, std::size_t frames,
                                            std::span<const schema::Gap> gaps);

  /// Positions in m from frame `first` on. Errors: of reading.
  schema::Result<void> read(std::size_t first, std::span<double> out) const;
  schema::Result<std::vector<double>> read(FrameRange frames) const;

  bool moves() const { return moves_; }
  double furthest_m() const { return furthest_m_; }  ///< largest stored |position|, for rounding
  const CounterWraps& wraps() const { return wraps_; }

 private:
  explicit PositionTrack(TouchSource& source) : source_(&source) {}
  schema::Result<void> survey(std::size_t frames, std::span<const schema::Gap> gaps);

  TouchSource* source_;
  std::vector<double> kept_m_;
  CounterWraps wraps_;
  bool moves_ = false;
  double furthest_m_ = 0;
};

}  // namespace tacto::spatial
